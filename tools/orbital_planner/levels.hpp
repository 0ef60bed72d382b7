// The level of autonomy along a line, from the expected difficulty of its ground: Full where it is hard, Efficient
// elsewhere, with hysteresis; no stretch shorter than a least length.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/orbital_planner/route.hpp"
#include "tools/orbital_planner/terrain.hpp"

namespace rover::orbital {

enum class Level : std::int8_t { kEfficient = 0, kFull = 1 };

struct LevelConfig {
  double full_above = 0.55;       // difficulty: Full from here on ...
  double efficient_below = 0.40;  // ... until it has fallen below this
  double mean_over_m = 8.0;       // of the line, about each point
  double corridor_m = 1.5;        // to each side of the line, where the rover may drive
  double lead_m = 4.0;            // Full begins that much earlier: its map has to be filled first
  double least_stretch_m = 20.0;  // Efficient ones that are shorter become Full, Full ones are lengthened
};

// Mean difficulty of the corridor at each point of the line.
std::vector<double> difficulty_along(const Line& line, const TerrainLayers& layers, const LevelConfig& config);

// One level for each point, of the way from it on; the last point's is the one before's.
std::vector<Level> levels_along(const Line& line, const std::vector<double>& difficulty, const LevelConfig& config);

}  // namespace rover::orbital
