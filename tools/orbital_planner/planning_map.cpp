#include "tools/orbital_planner/planning_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/geo/elevation_map_file.hpp"

namespace rover::orbital {
namespace {

constexpr int kStripCells = 100;  // rows of cells that are analysed at once

// Rows [first, end) of `strip` are appended.
void append_rows(const TerrainLayers& strip, int first, int end, TerrainLayers& layers) {
  const auto append = [&](const auto& from, auto& to) {
    to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(first) * strip.width,
              from.begin() + static_cast<std::ptrdiff_t>(end) * strip.width);
  };
  append(strip.slope_rad, layers.slope_rad);
  append(strip.roughness_m, layers.roughness_m);
  append(strip.step_m, layers.step_m);
  append(strip.difficulty, layers.difficulty);
  append(strip.terrain_class, layers.terrain_class);
}

TerrainLayers analyse_in_strips(const ElevationMapFile& file, int n, const TerrainConfig& config) {
  const ElevationRaster& frame = file.frame();
  TerrainLayers layers;
  layers.width = frame.width / n;
  layers.height = frame.height / n;
  layers.cell_m = frame.resolution_m * n;
  const int margin = static_cast<int>(std::ceil(config.window_m / layers.cell_m));  // of the planes, in cells
  for (int row = 0; row < layers.height; row += kStripCells) {
    const int from = std::max(0, row - margin), rows = std::min(kStripCells, layers.height - row);
    const ElevationRaster strip = file.read({0, from * n, frame.width, (row + rows + margin - from) * n});
    append_rows(analyse(strip, config, n), row - from, row - from + rows, layers);
  }
  return layers;
}

}  // namespace

PlanningMap read_planning_map(const std::string& file, const TerrainConfig& config, const MapLimits& limits) {
  PlanningMap result;
  if (!is_large_map(file, limits.pixels)) {
    result.map = read_elevation_map(file);
    result.terrain = analyse(result.map.raster, config);
    return result;
  }
  const ElevationMapFile large(file);
  const int n = blocks_for(large.frame(), limits.cells);
  result.map.raster = large.merged(n);
  result.map.notes.push_back(fmt::format("{}: {} x {} pixels of {:.4g} m, planned in cells of {:.4g} m", file,
                                         large.frame().width, large.frame().height, large.frame().resolution_m,
                                         result.map.raster.resolution_m));
  result.terrain = analyse_in_strips(large, n, config);
  return result;
}

}  // namespace rover::orbital
