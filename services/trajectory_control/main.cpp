#include "common/bus/node_main.hpp"
#include "trajectory_control/config.hpp"
#include "trajectory_control/node.hpp"

int main(int argc, char** argv) {
  using namespace rover;
  return node_main(argc, argv, "trajectory_control", control::load_config, [](const NodeContext& context) {
    return std::make_shared<control::TrajectoryControlNode>(context.node, control::load_config(context.config_dir));
  });
}
