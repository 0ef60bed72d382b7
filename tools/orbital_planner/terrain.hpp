// Terrain analysis by least-squares planes: slope, roughness (rms of residuals), step (height difference beyond the
// plane), class, difficulty.
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
  double window_m = 5.0;            // side of the plane's square: wide enough to average the noise of an orbital map
  double min_known_fraction = 0.5;  // fraction of the square with heights, else the cell is unknown
  double sloping_rad = to_rad(5.0);
  double steep_rad = to_rad(10.0);
  double max_slope_rad = to_rad(15.0);  // an obstacle above (HDPR)
  double rough_m = 0.15;
  double max_roughness_m = 0.30;  // an obstacle above
  double max_step_m = 0.40;       // an obstacle above: boulders and edges beyond the map noise
};

// Row by row from the south, as the elevation model. NaN if the class is unknown.
struct TerrainLayers {
  int width = 0;
  int height = 0;
  double cell_m = 0.0;
  std::vector<float> slope_rad;
  std::vector<float> roughness_m;
  std::vector<float> step_m;
  std::vector<float> difficulty;  // 0: level and smooth; 1: at or beyond a limit
  std::vector<TerrainClass> terrain_class;
};

// A cell of the layers is a block of n x n pixels, with the plane about its middle and its largest step. Pixels that
// fill no block are left out.
TerrainLayers analyse(const ElevationRaster& map, const TerrainConfig& config, int n = 1);

// Fraction of each class in the map.
std::array<double, kTerrainClasses> class_fractions(const TerrainLayers& layers);

}  // namespace rover::orbital
