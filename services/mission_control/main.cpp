#include "common/bus/node_main.hpp"
#include "mission_control/node.hpp"

int main(int argc, char** argv) {
  return rover::node_main(argc, argv, "mission_control", [](const rover::NodeContext& context) {
    return std::make_shared<rover::MissionControlNode>(context.node, rover::load_mission_plan(context.config_dir));
  });
}
