#include "common/bus/node_main.hpp"
#include "visual_odometry/config.hpp"
#include "visual_odometry/node.hpp"

int main(int argc, char** argv) {
  return rover::node_main(argc, argv, "visual_odometry", rover::vo::load_config, [](const rover::NodeContext& context) {
    return std::make_shared<rover::vo::OdometryNode>(context.node, rover::vo::load_config(context.config_dir));
  });
}
