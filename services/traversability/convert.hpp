// Conversion between messages and core types.
#pragma once

#include <rover/elevation_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/traversability_t.hpp>

#include "common/core/frames.hpp"
#include "traversability/traversability.hpp"

namespace rover::trav {

TerrainGrid grid_from(const elevation_t& message);

// Pose of the rover in odom; NaN if the message is invalid or lost.
Pose2 body_from(const pose_t& message);

void traversability_to(const TraversabilityMap& map, double difficulty, traversability_t& message);

}  // namespace rover::trav
