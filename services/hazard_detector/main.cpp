#include "common/bus/node_main.hpp"
#include "hazard_detector/config.hpp"
#include "hazard_detector/node.hpp"

int main(int argc, char** argv) {
  return rover::node_main(argc, argv, "hazard_detector", rover::hazard::load_config,
                          [](const rover::NodeContext& context) {
                            return rover::hazard::make_hazard_detector(context.node, context.config_dir);
                          });
}
