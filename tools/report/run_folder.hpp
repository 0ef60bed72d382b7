// A run's folder as the launcher leaves it: traverse.lcm, run.json, config/ and the orbital map.
#pragma once

#include <string>
#include <vector>

#include "tools/report/run_record.hpp"

namespace rover::report {

struct RunFolder {
  std::string dir;
  RunInfo info;
  Footprint footprint;
  std::string log;          // traverse.lcm
  std::string scenario;     // the effective scenario, empty where there is none
  std::string config_dir;   // the effective configuration
  std::string orbital_map;  // empty where there is none
};

// Throws ConfigError where the folder or its log is missing, or run.json is damaged. What else is missing is left
// empty; the vehicle then comes from `default_config_dir`.
RunFolder open_run_folder(const std::string& dir, const std::string& default_config_dir);

// Name and content of each file of the effective configuration.
std::vector<std::pair<std::string, std::string>> configuration_texts(const RunFolder& folder);

void write_file(const std::string& path, const std::string& content);
std::string read_file(const std::string& path);

}  // namespace rover::report
