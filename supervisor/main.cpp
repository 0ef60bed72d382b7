#include <cstdio>
#include <string>

#include "common/bus/node_main.hpp"
#include "common/bus/s6_client.hpp"
#include "supervisor/config.hpp"
#include "supervisor/node.hpp"

int main(int argc, char** argv) {
  if (argc == 2 && std::string(argv[1]) == "--drawing") {
    std::printf("%s", rover::supervisor::to_graphviz().c_str());
    return 0;
  }
  return rover::node_main(argc, argv, "supervisor", rover::supervisor::load_config,
                          [](const rover::NodeContext& context) {
                            const std::string run_dir = context.node.options().run_dir;
                            return std::make_shared<rover::supervisor::SupervisorNode>(
                                context.node, rover::supervisor::load_config(context.config_dir),
                                [run_dir](const std::string& service, const char* option) {
                                  return rover::control_service(run_dir, service, option);
                                });
                          });
}
