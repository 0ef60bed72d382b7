// Writes YAML files that are read back to the last bit.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace rover {

// Throws ConfigError where it cannot be written.
void write_yaml(const std::string& file, const YAML::Node& node);

}  // namespace rover
