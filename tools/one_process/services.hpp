// The services by name, to run on nodes within one process.
#pragma once

#include <string>

#include "tools/one_process/stack.hpp"

namespace rover {

// For each name of service_names(true). The supervisor cannot restart others, and mission_control serves no page.
Stack::Factory service_factory(const std::string& service, const std::string& config_dir);

}  // namespace rover
