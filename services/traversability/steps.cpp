#include "traversability/steps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rover::trav {
namespace {

// Grids padded with unseen cells, so that neighbour access needs no border check.
struct Padded {
  int reach;
  std::size_t stride;
  std::vector<float> height_m, variance_m2;

  Padded(const TerrainGrid& grid, int reach_cells)
      : reach(reach_cells), stride(static_cast<std::size_t>(grid.shape.cells_x + 2 * reach_cells)) {
    const std::size_t rows = static_cast<std::size_t>(grid.shape.cells_y + 2 * reach);
    height_m.assign(rows * stride, std::numeric_limits<float>::quiet_NaN());
    variance_m2 = height_m;
    for (int iy = 0; iy < grid.shape.cells_y; ++iy)
      for (int ix = 0; ix < grid.shape.cells_x; ++ix) {
        const std::size_t from = grid.shape.at(ix, iy);
        const std::size_t to = static_cast<std::size_t>(iy + reach) * stride + static_cast<std::size_t>(ix + reach);
        height_m[to] = grid.height_m[from];
        variance_m2[to] = grid.sigma_m[from] * grid.sigma_m[from];
      }
  }
};

struct Slopes {
  std::vector<float> x, y;

  // Zero without a plane.
  Slopes(const DiscPlanes& planes, std::size_t size) : x(size), y(size) {
    for (std::size_t i = 0; i < size; ++i) {
      const DiscPlane& plane = planes.at(i);
      x[i] = std::isnan(plane.slope_x) ? 0.0F : plane.slope_x;
      y[i] = std::isnan(plane.slope_y) ? 0.0F : plane.slope_y;
    }
  }
};

class StepFinder {
 public:
  StepFinder(const TerrainGrid& grid, const DiscPlanes& planes, const StepConfig& config)
      : shape_(grid.shape),
        padded_(grid, std::max(1, static_cast<int>(std::floor(config.radius_m / grid.shape.cell_m + 1e-9)))),
        slopes_(planes, grid.shape.size()),
        factor_(static_cast<float>(config.significance * config.significance)),
        reach_cells_(config.radius_m / grid.shape.cell_m) {
    steps_.rise_m.assign(shape_.size(), 0.0F);
    steps_.raw_rise_m = steps_.rise_m;
  }

  Steps find() {
    const int reach = padded_.reach;
    for (int dy = -reach; dy <= reach; ++dy)
      for (int dx = -reach; dx <= reach; ++dx) {
        const bool direct = std::max(std::abs(dx), std::abs(dy)) == 1;
        const bool within = dx * dx + dy * dy <= reach_cells_ * reach_cells_ + 1e-9;
        if ((dx == 0 && dy == 0) || (!within && !direct)) continue;
        for (int iy = 0; iy < shape_.cells_y; ++iy) compare_row(iy, dx, dy);
      }
    return std::move(steps_);
  }

 private:
  // Comparisons with NaN are false, so unseen cells are ignored.
  void compare_row(int iy, int dx, int dy) {
    const std::size_t own = static_cast<std::size_t>(iy + padded_.reach) * padded_.stride + padded_.reach;
    const std::size_t other = static_cast<std::size_t>(iy + padded_.reach + dy) * padded_.stride + padded_.reach + dx;
    const std::size_t first = shape_.at(0, iy);
    const float* z = padded_.height_m.data() + own;
    const float* z_other = padded_.height_m.data() + other;
    const float* variance = padded_.variance_m2.data() + own;
    const float* variance_other = padded_.variance_m2.data() + other;
    const float* slope_x = slopes_.x.data() + first;
    const float* slope_y = slopes_.y.data() + first;
    float* rise = steps_.rise_m.data() + first;
    float* raw = steps_.raw_rise_m.data() + first;
    const float offset_x = static_cast<float>(dx * shape_.cell_m), offset_y = static_cast<float>(dy * shape_.cell_m);
    for (int ix = 0; ix < shape_.cells_x; ++ix) {
      const float d = z[ix] - z_other[ix] + slope_x[ix] * offset_x + slope_y[ix] * offset_y;
      const float significant = d * d >= factor_ * (variance[ix] + variance_other[ix]) ? d : 0.0F;
      rise[ix] = significant > rise[ix] ? significant : rise[ix];
      raw[ix] = d > raw[ix] ? d : raw[ix];
    }
  }

  const GridShape& shape_;
  Padded padded_;
  Slopes slopes_;
  float factor_;
  double reach_cells_;
  Steps steps_;
};

}  // namespace

Steps find_steps(const TerrainGrid& grid, const DiscPlanes& planes, const StepConfig& config) {
  return StepFinder(grid, planes, config).find();
}

}  // namespace rover::trav
