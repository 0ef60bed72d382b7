// The axes that a campaign may have, and what each of their values means for a drive.
#pragma once

#include <string>
#include <vector>

#include "common/bus/config.hpp"
#include "common/bus/yaml_file.hpp"

namespace rover::campaign {

struct Axis {
  std::string name;
  Range range{0, 0};                 // of a number; empty for a choice
  std::vector<std::string> choices;  // empty for a number and for `fault`
  bool of_world = false;             // changes the scenario; the others are options of ./rover run
};

const std::vector<Axis>& axes();
// Nothing if the name is neither an axis nor a parameter.
const Axis* find_axis(const std::string& name);
// file.key of --set
bool is_parameter(const std::string& name);

// Value of the axis `fault`, "FAULT TARGET [AMOUNT]": a scenario's entry of `faults`, from 5 m on; null for none.
// Throws std::invalid_argument with what is wrong.
YAML::Node fault_entry(const std::string& value);

// What is wrong with a value of an axis; empty if nothing.
std::string value_problem(const Axis& axis, const std::string& value);
// The same for a parameter: the key must be in config_dir, and the value of the type that is there.
std::string parameter_problem(const std::string& config_dir, const std::string& name, const std::string& value);

}  // namespace rover::campaign
