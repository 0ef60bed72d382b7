#include "common/bus/node_main.hpp"
#include "slam/config.hpp"
#include "slam/node.hpp"

int main(int argc, char** argv) {
  return rover::node_main(argc, argv, "slam", rover::slam::load_config, [](const rover::NodeContext& context) {
    return rover::slam::make_slam(context.node, context.config_dir);
  });
}
