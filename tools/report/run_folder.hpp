// Run folder as the launcher writes it: traverse.lcm, run.json, config/ and the orbital map.
#pragma once

#include <string>
#include <vector>

#include "common/core/vehicle.hpp"
#include "tools/report/run_record.hpp"

namespace rover::report {

struct RunFolder {
  std::string dir;
  RunInfo info;
  Vehicle vehicle;
  Footprint footprint;
  std::string log;          // traverse.lcm
  std::string scenario;     // effective scenario; empty: none
  std::string config_dir;   // effective configuration
  std::string orbital_map;  // empty: none
};

// Throws ConfigError if folder or log is missing or run.json is invalid. Other missing files stay empty; default
// vehicle then.
RunFolder open_run_folder(const std::string& dir, const std::string& default_config_dir);

// Name and content of each file of the effective configuration.
std::vector<std::pair<std::string, std::string>> configuration_texts(const RunFolder& folder);

void write_file(const std::string& path, const std::string& content);
std::string read_file(const std::string& path);

}  // namespace rover::report
