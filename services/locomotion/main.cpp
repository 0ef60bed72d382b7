#include "common/bus/node_main.hpp"
#include "locomotion/config.hpp"
#include "locomotion/node.hpp"

int main(int argc, char** argv) {
  return rover::node_main(argc, argv, "locomotion", [](const rover::NodeContext& context) {
    return std::make_shared<rover::locomotion::LocomotionNode>(context.node,
                                                               rover::locomotion::load_config(context.config_dir));
  });
}
