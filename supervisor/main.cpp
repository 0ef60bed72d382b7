#include "common/bus/node_main.hpp"
#include "supervisor/config.hpp"
#include "supervisor/node.hpp"

int main(int argc, char** argv) {
  return rover::node_main(argc, argv, "supervisor", [](const rover::NodeContext& context) {
    return std::make_shared<rover::supervisor::SupervisorNode>(context.node,
                                                               rover::supervisor::load_config(context.config_dir));
  });
}
