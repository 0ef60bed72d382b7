// How hard the ground ahead of the rover is, as one number: the supervisor goes down to the Efficient level where it
// stays low.
#pragma once

#include "common/core/frames.hpp"
#include "traversability/traversability.hpp"

namespace rover::trav {

// 0 easy .. 1 hard: the larger of the mean cost and the share of the ground that lies too near to an obstacle for the
// rover. NaN where too little of the ground ahead is known. `body`: the rover in the grid's frame.
double difficulty_ahead(const TraversabilityMap& map, const Pose2& body, const AheadConfig& config);

}  // namespace rover::trav
