// In which values two configurations differ.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace rover::report {

using ConfigTexts = std::vector<std::pair<std::string, std::string>>;  // name and content of each file

struct ConfigDifference {
  std::string key;  // "path_planner: margin_m"
  std::string a;    // empty: not there
  std::string b;
};

// By file and key. A text that is no YAML is left out.
std::vector<ConfigDifference> config_differences(const ConfigTexts& a, const ConfigTexts& b);

}  // namespace rover::report
