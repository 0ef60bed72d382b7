// Values in which two configurations differ.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace rover::report {

using ConfigTexts = std::vector<std::pair<std::string, std::string>>;  // name and content of each file

struct ConfigDifference {
  std::string key;  // "path_planner: margin_m"
  std::string a;    // empty: key missing
  std::string b;
};

// Sorted by file and key. Files that are not YAML are ignored.
std::vector<ConfigDifference> config_differences(const ConfigTexts& a, const ConfigTexts& b);

}  // namespace rover::report
