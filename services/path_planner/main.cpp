#include "common/bus/node_main.hpp"
#include "path_planner/config.hpp"
#include "path_planner/node.hpp"

int main(int argc, char** argv) {
  return rover::node_main(argc, argv, "path_planner", rover::planning::load_config,
                          [](const rover::NodeContext& context) {
                            return std::make_shared<rover::planning::PathPlannerNode>(
                                context.node, rover::planning::load_config(context.config_dir));
                          });
}
