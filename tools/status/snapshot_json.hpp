// The status as one JSON document. Keys stand in a fixed order; null is what is not known.
#pragma once

#include <nlohmann/json.hpp>

#include "tools/status/snapshot.hpp"

namespace rover::status {

nlohmann::ordered_json to_json(const Snapshot& snapshot);

}  // namespace rover::status
