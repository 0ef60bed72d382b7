#include "traversability/small_holes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rover::trav {
namespace {

constexpr float kUnseen = std::numeric_limits<float>::quiet_NaN();
constexpr int kLeastNeighbours = 7;  // of 8; a hole of two cells leaves each of them seven

struct Patch {
  float height_m = 0.0F;
  float sigma_m = 0.0F;
};

class Holes {
 public:
  Holes(const TerrainGrid& grid, double even_m) : grid_(grid), shape_(grid.shape), even_m_(even_m) {}

  bool small(int ix, int iy) const {
    if (count_seen(ix, iy) < kLeastNeighbours) return false;
    bool all = true;
    for_neighbours(ix, iy, [&](int x, int y) {
      if (!seen(x, y)) all = all && shape_.contains(x, y) && count_seen(x, y) >= kLeastNeighbours;
    });
    return all;
  }

  // False where the neighbours do not agree.
  bool patch(int ix, int iy, Patch& out) const {
    float low = std::numeric_limits<float>::infinity(), high = -low, sum = 0.0F, sigma = 0.0F;
    int n = 0;
    for_neighbours(ix, iy, [&](int x, int y) {
      if (!seen(x, y)) return;
      const std::size_t i = shape_.at(x, y);
      low = std::min(low, grid_.height_m[i]);
      high = std::max(high, grid_.height_m[i]);
      sum += grid_.height_m[i];
      sigma = std::max(sigma, grid_.sigma_m[i]);
      ++n;
    });
    out = {sum / static_cast<float>(n), std::max(sigma, (high - low) / 2)};
    return high - low <= even_m_;
  }

  bool seen(int ix, int iy) const { return shape_.contains(ix, iy) && !std::isnan(grid_.height_m[shape_.at(ix, iy)]); }

 private:
  template <class F>
  static void for_neighbours(int ix, int iy, F&& f) {
    for (int y = iy - 1; y <= iy + 1; ++y)
      for (int x = ix - 1; x <= ix + 1; ++x)
        if (x != ix || y != iy) f(x, y);
  }
  int count_seen(int ix, int iy) const {
    int n = 0;
    for_neighbours(ix, iy, [&](int x, int y) { n += seen(x, y); });
    return n;
  }

  const TerrainGrid& grid_;
  const GridShape& shape_;
  double even_m_;
};

void forget_unusable(TerrainGrid& grid, double max_sigma_m) {
  for (std::size_t i = 0; i < grid.height_m.size(); ++i) {
    const float sigma = grid.sigma_m[i];
    const bool usable = std::isfinite(grid.height_m[i]) && sigma >= 0.0F && sigma <= max_sigma_m;
    if (!usable) grid.height_m[i] = grid.sigma_m[i] = kUnseen;
  }
}

}  // namespace

void close_small_holes(TerrainGrid& grid, double max_sigma_m, double even_m) {
  forget_unusable(grid, max_sigma_m);
  const Holes holes(grid, even_m);
  std::vector<std::pair<std::size_t, Patch>> patches;  // put in at the end: a patch closes no other hole
  for (int iy = 0; iy < grid.shape.cells_y; ++iy)
    for (int ix = 0; ix < grid.shape.cells_x; ++ix) {
      Patch patch;
      if (!holes.seen(ix, iy) && holes.small(ix, iy) && holes.patch(ix, iy, patch))
        patches.emplace_back(grid.shape.at(ix, iy), patch);
    }
  for (const auto& [i, patch] : patches) {
    grid.height_m[i] = patch.height_m;
    grid.sigma_m[i] = patch.sigma_m;
  }
}

}  // namespace rover::trav
