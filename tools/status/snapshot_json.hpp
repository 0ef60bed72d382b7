// Formats the status as one JSON document with a fixed key order; null: unknown.
#pragma once

#include <nlohmann/json.hpp>

#include "tools/status/snapshot.hpp"

namespace rover::status {

nlohmann::ordered_json to_json(const Snapshot& snapshot);

}  // namespace rover::status
