#include "common/bus/node_main.hpp"
#include "traversability/config.hpp"
#include "traversability/node.hpp"

int main(int argc, char** argv) {
  return rover::node_main(argc, argv, "traversability", rover::trav::load_config,
                          [](const rover::NodeContext& context) {
                            return rover::trav::make_traversability(context.node, context.config_dir);
                          });
}
