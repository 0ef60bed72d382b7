#include "tools/report/config_difference.hpp"

#include <yaml-cpp/yaml.h>

#include <map>

#include "common/bus/config.hpp"
#include "common/bus/yaml_file.hpp"

namespace rover::report {
namespace {

using Values = std::map<std::string, std::string>;

// A list of scalars is compared as one value.
bool is_value(const YAML::Node& node) {
  if (node.IsScalar() || node.IsNull()) return true;
  if (!node.IsSequence()) return false;
  for (const YAML::Node& item : node)
    if (!item.IsScalar()) return false;
  return true;
}

std::string value_text(const YAML::Node& node) {
  if (!node.IsSequence()) return node.IsNull() ? "~" : node.Scalar();
  std::string text;
  for (const YAML::Node& item : node) text += (text.empty() ? "" : ", ") + item.Scalar();
  return "[" + text + "]";
}

void flatten(const std::string& key, const YAML::Node& node, Values& out) {
  if (is_value(node)) {
    out[key] = value_text(node);
  } else if (node.IsSequence()) {
    for (size_t i = 0; i < node.size(); ++i) flatten(key + "[" + std::to_string(i) + "]", node[i], out);
  } else {
    for (const auto& item : node)
      flatten(key + (key.ends_with(' ') ? "" : ".") + item.first.Scalar(), item.second, out);
  }
}

Values values_of(const ConfigTexts& texts) {
  Values out;
  for (const auto& [name, text] : texts) {
    const std::string key = name.substr(0, name.rfind('.')) + ": ";
    try {
      flatten(key, parse_yaml(text, name), out);
    } catch (const ConfigError& error) {
      out[key] = error.what();
    }
  }
  return out;
}

}  // namespace

std::vector<ConfigDifference> config_differences(const ConfigTexts& a, const ConfigTexts& b) {
  const Values of_a = values_of(a);
  const Values of_b = values_of(b);
  std::map<std::string, ConfigDifference> all;
  for (const auto& [key, value] : of_a) all[key] = {key, value, ""};
  for (const auto& [key, value] : of_b) {
    all[key].key = key;
    all[key].b = value;
  }
  std::vector<ConfigDifference> out;
  for (const auto& [key, difference] : all)
    if (difference.a != difference.b) out.push_back(difference);
  return out;
}

}  // namespace rover::report
