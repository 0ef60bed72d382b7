// Zones as JSON: [{"name": "dune", "kind": "keep_out", "points": [[x, y], ...]}, ...], in map [m].
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "common/core/zones.hpp"

namespace rover::mission {

nlohmann::json zones_json(const std::vector<Zone>& zones);
// Throws nlohmann::json::exception if it is not such a list. Whether they are zones: zones_problem().
std::vector<Zone> zones_from(const nlohmann::json& list);

}  // namespace rover::mission
