#include "traversability/hole_filling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rover::trav {
namespace {

constexpr float kUnseen = std::numeric_limits<float>::quiet_NaN();
constexpr int kMinNeighbours = 7;  // of 8: each cell of a two-cell hole has seven

struct Fill {
  float height_m = 0.0F;
  float sigma_m = 0.0F;
};

class Holes {
 public:
  Holes(const TerrainGrid& grid, double max_height_difference_m)
      : grid_(grid), shape_(grid.shape), max_height_difference_m_(max_height_difference_m) {}

  bool is_small(int ix, int iy) const {
    if (count_seen(ix, iy) < kMinNeighbours) return false;
    bool all = true;
    for_each_neighbour(ix, iy, [&](int x, int y) {
      if (!seen(x, y)) all = all && shape_.contains(x, y) && count_seen(x, y) >= kMinNeighbours;
    });
    return all;
  }

  // False if the neighbours' heights differ too much.
  bool fill(int ix, int iy, Fill& out) const {
    float low = std::numeric_limits<float>::infinity(), high = -low, sum = 0.0F, sigma = 0.0F;
    int n = 0;
    for_each_neighbour(ix, iy, [&](int x, int y) {
      if (!seen(x, y)) return;
      const std::size_t i = shape_.at(x, y);
      low = std::min(low, grid_.height_m[i]);
      high = std::max(high, grid_.height_m[i]);
      sum += grid_.height_m[i];
      sigma = std::max(sigma, grid_.sigma_m[i]);
      ++n;
    });
    out = {sum / static_cast<float>(n), std::max(sigma, (high - low) / 2)};
    return high - low <= max_height_difference_m_;
  }

  bool seen(int ix, int iy) const { return shape_.contains(ix, iy) && !std::isnan(grid_.height_m[shape_.at(ix, iy)]); }

 private:
  template <class F>
  static void for_each_neighbour(int ix, int iy, F&& f) {
    for (int y = iy - 1; y <= iy + 1; ++y)
      for (int x = ix - 1; x <= ix + 1; ++x)
        if (x != ix || y != iy) f(x, y);
  }
  int count_seen(int ix, int iy) const {
    int n = 0;
    for_each_neighbour(ix, iy, [&](int x, int y) { n += seen(x, y); });
    return n;
  }

  const TerrainGrid& grid_;
  const GridShape& shape_;
  double max_height_difference_m_;
};

void invalidate_unusable(TerrainGrid& grid, double max_sigma_m) {
  for (std::size_t i = 0; i < grid.height_m.size(); ++i) {
    const float sigma = grid.sigma_m[i];
    const bool usable = std::isfinite(grid.height_m[i]) && sigma >= 0.0F && sigma <= max_sigma_m;
    if (!usable) grid.height_m[i] = grid.sigma_m[i] = kUnseen;
  }
}

}  // namespace

void fill_small_holes(TerrainGrid& grid, double max_sigma_m, double max_height_difference_m) {
  invalidate_unusable(grid, max_sigma_m);
  const Holes holes(grid, max_height_difference_m);
  std::vector<std::pair<std::size_t, Fill>> fills;  // applied at the end: a fill must not enable another
  for (int iy = 0; iy < grid.shape.cells_y; ++iy)
    for (int ix = 0; ix < grid.shape.cells_x; ++ix) {
      Fill fill;
      if (!holes.seen(ix, iy) && holes.is_small(ix, iy) && holes.fill(ix, iy, fill))
        fills.emplace_back(grid.shape.at(ix, iy), fill);
    }
  for (const auto& [i, fill] : fills) {
    grid.height_m[i] = fill.height_m;
    grid.sigma_m[i] = fill.sigma_m;
  }
}

}  // namespace rover::trav
