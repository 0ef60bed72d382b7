// Level of autonomy along a line by expected terrain difficulty: Full if hard, with hysteresis and a minimum segment
// length.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/orbital_planner/route.hpp"
#include "tools/orbital_planner/terrain.hpp"

namespace rover::orbital {

enum class Level : std::int8_t { kEfficient = 0, kFull = 1 };

struct LevelConfig {
  double full_above = 0.55;            // difficulty: enter Full above this
  double efficient_below = 0.40;       // leave Full below this
  double averaging_distance_m = 8.0;   // arc length of the moving average
  double corridor_half_width_m = 1.5;  // the rover may drive anywhere in the corridor
  double lead_distance_m = 4.0;        // Full starts this much earlier, to fill its map first
  double min_segment_length_m = 20.0;  // shorter Efficient segments become Full, shorter Full ones are lengthened
};

// Mean difficulty of the corridor at each point of the line.
std::vector<double> difficulty_along(const Line& line, const TerrainLayers& layers, const LevelConfig& config);

// Level of the segment that starts at each point; the last point repeats the one before.
std::vector<Level> levels_along(const Line& line, const std::vector<double>& difficulty, const LevelConfig& config);

}  // namespace rover::orbital
