// Between the messages and the core.
#pragma once

#include <rover/elevation_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/traversability_t.hpp>
#include <string>

#include "common/core/frames.hpp"
#include "traversability/traversability.hpp"

namespace rover::trav {

// What is wrong with the message; empty: nothing. Single cells may be NaN.
std::string fault_of(const elevation_t& message);
TerrainGrid grid_from(const elevation_t& message);

// The rover in odom; NaN where the message is of no use.
Pose2 body_from(const pose_t& message);

void traversability_to(const TraversabilityMap& map, double difficulty, traversability_t& message);

}  // namespace rover::trav
