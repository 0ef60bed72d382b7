// Traversability of the ground: what the rover's wheels and body make of an elevation map.
//
// Slope and roughness come from a plane over a disc of the rover's size, steps from height differences within a wheel's
// reach (as in GESTALT: Goldberg, Maimone and Matthies, IEEE Aerospace 2002), weighed against the heights' own sigma.
// What was not seen, or not well enough, is a class of its own.
#pragma once

#include <cstdint>
#include <vector>

#include "traversability/disc_planes.hpp"
#include "traversability/steps.hpp"
#include "traversability/terrain_grid.hpp"
#include "traversability/traversability_config.hpp"

namespace rover::trav {

inline constexpr std::uint8_t kImpassable = 254;
inline constexpr std::uint8_t kUnknown = 255;

struct TraversabilityMap {
  GridShape shape;
  std::vector<std::uint8_t> cells;     // 0 free .. 253 dear, kImpassable, kUnknown
  std::vector<std::uint8_t> obstacle;  // 1: a rock, a step or a hole (slope is none)
};

TraversabilityMap judge_terrain(TerrainGrid grid, const TraversabilityConfig& config);

}  // namespace rover::trav
