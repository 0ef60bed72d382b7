// Rover-frame grid; cell index is iy * cells_x + ix.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "hazard_detector/hazard_config.hpp"

namespace rover::hazard {

struct GridShape {
  int cells_x = 0;
  int cells_y = 0;
  double cell_m = 0.0;
  double origin_x_m = 0.0;  // corner with the smallest x and y
  double origin_y_m = 0.0;

  explicit GridShape(const GridConfig& config)
      : cells_x(static_cast<int>(std::lround((config.max_x_m - config.min_x_m) / config.cell_m))),
        cells_y(static_cast<int>(std::lround(2.0 * config.half_width_m / config.cell_m))),
        cell_m(config.cell_m),
        origin_x_m(config.min_x_m),
        origin_y_m(-config.half_width_m) {}

  int size() const { return cells_x * cells_y; }
  bool contains(int ix, int iy) const { return ix >= 0 && iy >= 0 && ix < cells_x && iy < cells_y; }
  int at(int ix, int iy) const { return iy * cells_x + ix; }
  double x_m(int ix) const { return origin_x_m + (ix + 0.5) * cell_m; }
  double y_m(int iy) const { return origin_y_m + (iy + 0.5) * cell_m; }
};

// Sample counts of one cell.
struct CellEvidence {
  int measured = 0;   // samples with valid stereo whose 3-D point lies in the cell
  int expected = 0;   // samples that would hit the ground of the cell without occlusion
  int high = 0;       // above the obstacle limit T_near
  int tall = 0;       // too high to pass under the body
  int raised = 0;     // above grow_height_m
  int low = 0;        // below the hole limit T_far
  int over = 0;       // whose rays pass the cell at the height of the body
  int over_seen = 0;  // of them, with valid stereo: what is there is lower, or counts as tall
  float sum_z_m = 0;  // sum of heights over flat ground
};

enum class Cell : std::int8_t { kUnseen = 0, kFree = 1, kObstacle = 2, kHole = 3, kMargin = 4, kLow = 5 };

inline bool is_hazard(Cell cell) {
  return cell == Cell::kObstacle || cell == Cell::kHole || cell == Cell::kLow;
}

}  // namespace rover::hazard
