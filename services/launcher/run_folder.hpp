// A run's folder: the effective configuration, the orbital map and the ground's orders, laid out before anything starts.
#pragma once

#include <string>

#include "launcher/arguments.hpp"

namespace rover {

struct RunFolder {
  std::string dir;          // absolute
  std::string config_dir;   // dir/config: the effective configuration
  std::string scenario;     // dir/config/scenario.yaml
  std::string bus_url;
  std::int64_t seed = 0;
};

// Throws ConfigError with one line where the scenario, a key or a value is not right, or the folder is not writable.
RunFolder make_run_folder(const RunArguments& arguments);

}  // namespace rover
