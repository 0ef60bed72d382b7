// Zones in messages and in YAML files.
#pragma once

#include <rover/path_t.hpp>
#include <vector>

#include "common/bus/config.hpp"
#include "common/core/zones.hpp"

namespace rover {

// Throws ConfigError unless the list `zones` is one; no key: no zones.
std::vector<Zone> read_zones(const Config& config);
std::vector<Zone> zones_from(const path_t& message);
void zones_to(const std::vector<Zone>& zones, path_t& message);

}  // namespace rover
