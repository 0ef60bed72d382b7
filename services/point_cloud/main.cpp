#include "common/bus/node_main.hpp"
#include "point_cloud/config.hpp"
#include "point_cloud/node.hpp"

int main(int argc, char** argv) {
  return rover::node_main(argc, argv, "point_cloud", rover::cloud::load_config, [](const rover::NodeContext& context) {
    return rover::cloud::make_point_cloud(context.node, context.config_dir);
  });
}
