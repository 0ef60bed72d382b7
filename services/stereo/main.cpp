#include "common/bus/node_main.hpp"
#include "stereo/config.hpp"
#include "stereo/node.hpp"

int main(int argc, char** argv) {
  return rover::node_main(argc, argv, "stereo", rover::stereo::load_config, [](const rover::NodeContext& context) {
    return rover::stereo::make_stereo(context.node, context.config_dir);
  });
}
