#include "common/bus/node_main.hpp"
#include "trajectory_control/config.hpp"
#include "trajectory_control/node.hpp"

int main(int argc, char** argv) {
  return rover::node_main(argc, argv, "trajectory_control", [](const rover::NodeContext& context) {
    return std::make_shared<rover::control::TrajectoryControlNode>(context.node,
                                                                   rover::control::load_config(context.config_dir));
  });
}
