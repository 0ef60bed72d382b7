// Difficulty of the terrain ahead as one number. The supervisor selects the Efficient level while it stays low.
#pragma once

#include "common/core/frames.hpp"
#include "traversability/traversability.hpp"

namespace rover::trav {

// 0 easy .. 1 hard: the larger of the mean cost and the share of cells within `clearance_m` of an obstacle. NaN if too
// few cells ahead are known. `body`: pose of the rover in the grid's frame.
double difficulty_ahead(const TraversabilityMap& map, const Pose2& body, const AheadConfig& config);

}  // namespace rover::trav
