// Reads YAML strictly, and writes YAML that is read back to the last bit. Strict: UTF-8 of at most 1 MB, exactly one
// document, no anchor, alias, merge key, tag or key that is not a text, no key twice and no key without a value.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace rover {

// Throws ConfigError "NAME:LINE: KEY: what is wrong".
YAML::Node parse_yaml(const std::string& text, const std::string& name);
// Throws ConfigError also where the file cannot be read.
YAML::Node load_yaml(const std::string& file);

// Throws ConfigError where it cannot be written.
void write_yaml(const std::string& file, const YAML::Node& node);

}  // namespace rover
