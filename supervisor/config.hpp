// Reads supervisor.yaml and fdir.yaml; keys that are absent keep the defaults of the core.
#pragma once

#include <string>

#include "supervisor/supervisor.hpp"

namespace rover::supervisor {

SupervisorConfig load_config(const std::string& config_dir);

}  // namespace rover::supervisor
