#include "tools/status/target.hpp"

#include <cstdio>
#include <filesystem>

#include "common/bus/config.hpp"
#include "common/bus/node_main.hpp"
#include "tools/status/running_run.hpp"

namespace rover::status {

std::optional<Target> find_target(const TargetArguments& arguments) {
  if (!arguments.run.empty() && !std::filesystem::is_directory(arguments.run))
    throw ConfigError(arguments.run + ": no such run folder");
  const std::optional<std::string> run = arguments.run.empty()       ? newest_running(arguments.logs_dir)
                                         : is_running(arguments.run) ? std::optional(arguments.run)
                                                                     : std::nullopt;
  if (run) {
    const std::string dir = std::filesystem::canonical(*run);
    const std::string own_bus = load_bus_url(dir + "/config");
    // If --bus differs from the running run's bus, the run is not the target.
    const bool other_bus = arguments.run.empty() && !arguments.bus.empty() && arguments.bus != own_bus;
    return other_bus ? Target{"", arguments.bus} : Target{dir, arguments.bus.empty() ? own_bus : arguments.bus};
  }
  if (arguments.run.empty() && !arguments.bus.empty()) return Target{"", arguments.bus};
  if (arguments.run.empty()) {
    std::fprintf(
        stderr,
        "no rover is running: no running services in %s. Start one with ./rover run, or select a bus with --bus\n",
        arguments.logs_dir.c_str());
  } else {
    std::fprintf(stderr, "%s: no services are running\n", arguments.run.c_str());
  }
  return std::nullopt;
}

}  // namespace rover::status
