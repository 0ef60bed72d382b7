#include "common/bus/node_main.hpp"
#include "common/bus/vehicle_config.hpp"
#include "localization/config.hpp"
#include "localization/node.hpp"

int main(int argc, char** argv) {
  return rover::node_main(argc, argv, "localization", rover::loc::load_config, [](const rover::NodeContext& context) {
    return std::make_shared<rover::loc::LocalizationNode>(context.node, rover::loc::load_config(context.config_dir),
                                                          rover::load_vehicle(context.config_dir));
  });
}
