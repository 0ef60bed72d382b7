// config/supervisor.yaml over the defaults of the core.
#pragma once

#include <string>

#include "supervisor/supervisor.hpp"

namespace rover::supervisor {

SupervisorConfig load_config(const std::string& config_dir);

}  // namespace rover::supervisor
