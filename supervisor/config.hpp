// Describes and reads config/supervisor.yaml and reads the fault table config/fdir.yaml. Speed and motor limits come
// from config/vehicle.yaml, values that other services share from config/navigation.yaml.
#pragma once

#include <string>

#include "common/bus/parameters.hpp"
#include "supervisor/supervisor.hpp"

namespace rover::supervisor {

// With a list, fdir.yaml is not read: its rows are no parameters.
SupervisorConfig load_config(const std::string& config_dir, ParameterList* list = nullptr);

}  // namespace rover::supervisor
