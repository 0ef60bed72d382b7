#include "common/bus/node_main.hpp"
#include "global_localization/config.hpp"
#include "global_localization/node.hpp"

int main(int argc, char** argv) {
  return rover::node_main(argc, argv, "global_localization", rover::global::load_config,
                          [](const rover::NodeContext& context) {
                            return rover::global::make_global_localization(context.node, context.config_dir);
                          });
}
