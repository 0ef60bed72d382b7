// Traversability costs from an elevation map. Slope and roughness come from a plane over a disc of the rover's size,
// steps from height differences within a wheel diameter (as in GESTALT: Goldberg, Maimone and Matthies, IEEE Aerospace
// 2002), tested against the heights' sigma. Cells not seen well enough are a class of their own.
#pragma once

#include <cstdint>
#include <vector>

#include "traversability/disc_planes.hpp"
#include "traversability/steps.hpp"
#include "traversability/terrain_grid.hpp"
#include "traversability/traversability_config.hpp"

namespace rover::trav {

inline constexpr std::uint8_t kLow = 253;  // impassable for the wheels; the body passes over it
inline constexpr std::uint8_t kImpassable = 254;
inline constexpr std::uint8_t kUnknown = 255;

struct TraversabilityMap {
  GridShape shape;
  std::vector<std::uint8_t> cells;         // cost 0 .. 252, kLow, kImpassable or kUnknown
  std::vector<std::uint8_t> obstacle;      // 1: rock, step or hole; steep slopes are not included
  std::vector<std::uint8_t> step_percent;  // significant rise, of the limit
  std::vector<float> height_m;             // of the grid, small holes filled
};

TraversabilityMap compute_traversability(TerrainGrid grid, const TraversabilityConfig& config);

}  // namespace rover::trav
