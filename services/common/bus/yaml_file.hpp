// Strict YAML: UTF-8 of at most 1 MB, exactly one document; no anchors, aliases, merge keys, tags, non-text keys,
// duplicate keys or missing values. Written numbers round-trip exactly.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace rover {

// Throws ConfigError "NAME:LINE: KEY: what is wrong".
YAML::Node parse_yaml(const std::string& text, const std::string& name);
// Throws ConfigError also if the file cannot be read.
YAML::Node load_yaml(const std::string& file);

// Throws ConfigError if it cannot be written.
void write_yaml(const std::string& file, const YAML::Node& node);

}  // namespace rover
