// metrics.json: consistency of the pose, fidelity of the maps.
#pragma once

#include <nlohmann/json.hpp>

#include "tools/report/map_fidelity.hpp"
#include "tools/report/pose_consistency.hpp"
#include "tools/report/visual_consistency.hpp"

namespace rover::report {

// null without samples. `lower`, `upper`: bounds of `xyyaw` for one run.
nlohmann::ordered_json anees_json(const PoseConsistency& pose);
nlohmann::ordered_json vo_nees_json(const VisualConsistency& visual);
// Arrays by class of height, then of range; ratios of classes that were never observed are null.
nlohmann::ordered_json map_json(const MapFidelities& maps);

}  // namespace rover::report
