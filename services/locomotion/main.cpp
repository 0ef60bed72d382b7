#include "common/bus/node_main.hpp"
#include "locomotion/config.hpp"
#include "locomotion/node.hpp"

int main(int argc, char** argv) {
  using namespace rover;
  return node_main(argc, argv, "locomotion", locomotion::load_config, [](const NodeContext& context) {
    return std::make_shared<locomotion::LocomotionNode>(context.node, locomotion::load_config(context.config_dir));
  });
}
