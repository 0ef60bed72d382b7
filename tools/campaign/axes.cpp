#include "tools/campaign/axes.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <sstream>
#include <stdexcept>

#include "common/bus/faults.hpp"
#include "common/core/decimal.hpp"

namespace rover::campaign {
namespace {

// "a, b, c"
std::string listed(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

std::vector<std::string> split(const std::string& name) {
  std::vector<std::string> keys;
  std::istringstream parts(name + ".");
  for (std::string key; std::getline(parts, key, '.');) keys.push_back(key);
  return keys;
}

bool is_truth_value(const std::string& text) {
  return text == "true" || text == "false";
}

// Type of the configured value against that of the new one.
std::string type_problem(const YAML::Node& present, const std::string& value) {
  if (!present.IsScalar()) return "is a section or a list; an axis changes single values only";
  if (parse_number(present.Scalar()) && !parse_number(value)) return "'" + value + "' is not a number";
  if (is_truth_value(present.Scalar()) && !is_truth_value(value)) return "'" + value + "' is neither true nor false";
  return {};
}

}  // namespace

const std::vector<Axis>& axes() {
  // Ranges as in services/rover_simulator/world/scenario.cpp.
  static const std::vector<Axis> known = {
      {"rock_area", {0, 0.4}, {}, true},
      {"slope_deg", {0, 35}, {}, true},
      {"slope_direction", {0, 0}, {"down", "up", "across"}, true},
      {"soil", {0, 0}, {"sand", "firm", "bedrock", "mixed"}, true},
      {"sun_elevation_deg", {5, 90}, {}, true},
      {"fault", {0, 0}, {}, true},
      {"level", {0, 0}, {"efficient", "auto", "full"}},
      {"perception", {0, 0}, {"rendered", "geometric", "truth"}},
  };
  return known;
}

const Axis* find_axis(const std::string& name) {
  const auto axis = std::find_if(axes().begin(), axes().end(), [&](const Axis& known) { return known.name == name; });
  return axis == axes().end() ? nullptr : &*axis;
}

bool is_parameter(const std::string& name) {
  const std::vector<std::string> keys = split(name);
  return keys.size() >= 2 && std::all_of(keys.begin(), keys.end(), [](const std::string& key) {
           return !key.empty() &&
                  std::all_of(key.begin(), key.end(), [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
         });
}

YAML::Node fault_entry(const std::string& value) {
  if (value == "none") return {};
  std::istringstream words(value);
  std::string name, target, amount, rest;
  words >> name >> target >> amount >> rest;
  const FaultKind* kind = find_fault(name);
  if (kind == nullptr) throw std::invalid_argument("'" + name + "' is not one of none, " + fault_names());
  std::string problem = target_problem(*kind, target, find_channel_type);
  const auto number = parse_number(amount);
  if (problem.empty() && !amount.empty() && (!number || !rest.empty()))
    problem = "'" + amount + (rest.empty() ? "" : " " + rest) + "' is not an amount";
  if (problem.empty()) problem = amount_problem(*kind, number.value_or(kind->default_amount));
  if (!problem.empty()) throw std::invalid_argument(problem);
  YAML::Node entry;
  entry["fault"] = name;
  entry["target"] = target;
  if (number) entry["amount"] = *number;
  entry["after_m"] = 5.0;
  return entry;
}

std::string value_problem(const Axis& axis, const std::string& value) {
  if (axis.name == "fault") {
    try {
      fault_entry(value);
      return {};
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
  }
  if (!axis.choices.empty()) {
    const bool known = std::find(axis.choices.begin(), axis.choices.end(), value) != axis.choices.end();
    return known ? "" : "'" + value + "' is not one of " + listed(axis.choices);
  }
  const auto number = parse_number(value);
  if (!number) return "'" + value + "' is not a number";
  if (*number >= axis.range.min && *number <= axis.range.max) return {};
  std::ostringstream text;
  text << value << " is out of range [" << axis.range.min << ", " << axis.range.max << "]";
  return text.str();
}

std::string parameter_problem(const std::string& config_dir, const std::string& name, const std::string& value) {
  const std::vector<std::string> keys = split(name);
  const std::string file = keys.front() + ".yaml";
  std::error_code ignored;  // name too long
  if (!std::filesystem::exists(config_dir + "/" + file, ignored)) return "there is no config/" + file;
  YAML::Node node = load_yaml(config_dir + "/" + file);
  for (size_t i = 1; i < keys.size(); ++i) {
    const YAML::Node child = node.IsMap() ? node[keys[i]] : YAML::Node(YAML::NodeType::Undefined);
    if (!child.IsDefined()) return "config/" + file + " has no '" + keys[i] + "' there";
    node.reset(child);
  }
  return type_problem(node, value);
}

}  // namespace rover::campaign
