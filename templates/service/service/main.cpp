#include "@NAME@/config.hpp"
#include "@NAME@/node.hpp"
#include "common/bus/node_main.hpp"

int main(int argc, char** argv) {
  return rover::node_main(argc, argv, "@NAME@", rover::@NAME@::load_config, [](const rover::NodeContext& context) {
    return rover::@NAME@::make_@NAME@(context.node, context.config_dir);
  });
}
