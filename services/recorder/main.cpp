#include "common/bus/node_main.hpp"
#include "recorder/config.hpp"
#include "recorder/node.hpp"

int main(int argc, char** argv) {
  return rover::node_main(argc, argv, "recorder", rover::recorder::load_config, [](const rover::NodeContext& context) {
    return rover::recorder::make_recorder(context.node, context.config_dir);
  });
}
