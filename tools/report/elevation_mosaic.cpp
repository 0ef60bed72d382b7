#include "tools/report/elevation_mosaic.hpp"

#include <algorithm>
#include <cmath>

#include "common/core/frames.hpp"

namespace rover::report {
namespace {

struct Place {
  std::pair<int, int> tile;
  size_t index;
};

Place place_of(int column, int row, int side) {
  const auto floored = [side](int i) { return i >= 0 ? i / side : -((side - 1 - i) / side); };
  const int tx = floored(column), ty = floored(row);
  return {{tx, ty}, static_cast<size_t>((row - ty * side) * side + column - tx * side)};
}

int cell_of(double at_m, double cell_m) {
  return static_cast<int>(std::floor(at_m / cell_m));
}

}  // namespace

void ElevationMosaic::add(double cell_m, double origin_x_m, double origin_y_m, int columns,
                          const std::vector<float>& height_m) {
  constexpr double kReachM = 1e6;  // limit of the map coordinates
  if (!(cell_m > 0.0) || columns <= 0 || !(std::abs(origin_x_m) < kReachM && std::abs(origin_y_m) < kReachM)) return;
  if (tiles_.empty()) {
    cell_m_ = cell_m;
    bounds_ = {kInfinity, kInfinity, -kInfinity, -kInfinity};
  }
  if (cell_m != cell_m_) return;
  const int column0 = cell_of(origin_x_m + 0.5 * cell_m, cell_m), row0 = cell_of(origin_y_m + 0.5 * cell_m, cell_m);
  for (size_t i = 0; i < height_m.size(); ++i) {
    if (!std::isfinite(height_m[i])) continue;
    const int column = column0 + static_cast<int>(i) % columns, row = row0 + static_cast<int>(i) / columns;
    const Place place = place_of(column, row, kSide);
    Tile& tile = tiles_[place.tile];
    if (tile.empty()) tile.assign(kSide * kSide, static_cast<float>(kNaN));
    tile[place.index] = height_m[i];
    bounds_.x0_m = std::min(bounds_.x0_m, column * cell_m);
    bounds_.y0_m = std::min(bounds_.y0_m, row * cell_m);
    bounds_.x1_m = std::max(bounds_.x1_m, (column + 1) * cell_m);
    bounds_.y1_m = std::max(bounds_.y1_m, (row + 1) * cell_m);
  }
}

float ElevationMosaic::at(double x_m, double y_m) const {
  if (tiles_.empty()) return static_cast<float>(kNaN);
  const Place place = place_of(cell_of(x_m, cell_m_), cell_of(y_m, cell_m_), kSide);
  const auto tile = tiles_.find(place.tile);
  return tile == tiles_.end() ? static_cast<float>(kNaN) : tile->second[place.index];
}

}  // namespace rover::report
