// What an orbital elevation model says of the ground, cell by cell: slope, roughness, steps, class, difficulty.
// A plane is fitted by least squares to a square around each cell: slope is the plane's, roughness the rms of what the
// plane leaves, step the greatest difference to a neighbouring cell beyond the plane's own.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/core/frames.hpp"
#include "common/geo/elevation_raster.hpp"

namespace rover::orbital {

enum class TerrainClass : std::uint8_t { kUnknown, kLevel, kSloping, kSteep, kRough, kObstacle };
constexpr size_t kTerrainClasses = 6;
const char* name_of(TerrainClass c);

struct TerrainConfig {
  double window_m = 5.0;     // side of the plane's square: wide enough against the noise of a map from orbit
  double least_known = 0.5;  // share of the square with heights; below it a cell is unknown
  double sloping_rad = to_rad(5.0);
  double steep_rad = to_rad(10.0);
  double most_slope_rad = to_rad(15.0);  // steeper: an obstacle (HDPR)
  double rough_m = 0.15;
  double most_roughness_m = 0.30;  // rougher: an obstacle
  double most_step_m = 0.40;       // a boulder or an edge that stands out of the noise of the map
};

// Row by row from the south, as the elevation model. NaN where the class is unknown.
struct TerrainLayers {
  int width = 0;
  int height = 0;
  double cell_m = 0.0;
  std::vector<float> slope_rad;
  std::vector<float> roughness_m;
  std::vector<float> step_m;
  std::vector<float> difficulty;  // 0: level and smooth; 1: at one of the limits or beyond
  std::vector<TerrainClass> terrain_class;
};

TerrainLayers analyse(const ElevationRaster& map, const TerrainConfig& config);

// Share of each class in the map.
std::array<double, kTerrainClasses> class_shares(const TerrainLayers& layers);

}  // namespace rover::orbital
