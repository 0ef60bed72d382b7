#include "common/bus/node_main.hpp"
#include "pan_tilt/config.hpp"
#include "pan_tilt/node.hpp"

int main(int argc, char** argv) {
  return rover::node_main(argc, argv, "pan_tilt", rover::gaze::load_config, [](const rover::NodeContext& context) {
    return rover::gaze::make_pan_tilt(context.node, context.config_dir);
  });
}
