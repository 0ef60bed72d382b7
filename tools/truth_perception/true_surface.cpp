#include "tools/truth_perception/true_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rover::truth {
namespace {

constexpr double kTileM = 1.0;
constexpr int kSquares = 50;  // of a tile's side
static_assert(kSquares * TrueSurface::kSpacingM == kTileM);
constexpr std::size_t kMaxTiles = 4096;  // 43 MB

}  // namespace

const TrueSurface::Tile& TrueSurface::tile(std::int64_t column, std::int64_t row) {
  const std::int64_t key = row * (std::int64_t{1} << 32) + column;
  if (newest_ != nullptr && key == newest_key_) return *newest_;
  if (tiles_.size() >= kMaxTiles && !tiles_.contains(key)) tiles_.clear();
  Tile& tile = tiles_[key];
  newest_key_ = key;
  newest_ = &tile;
  if (!tile.empty()) return tile;
  tile.reserve((kSquares + 1) * (kSquares + 1));
  for (int j = 0; j <= kSquares; ++j)
    for (int i = 0; i <= kSquares; ++i)
      tile.push_back(static_cast<float>(surface_.height_m(static_cast<double>(column) * kTileM + i * kSpacingM,
                                                          static_cast<double>(row) * kTileM + j * kSpacingM)));
  return tile;
}

double TrueSurface::height_m(double x_m, double y_m) {
  const double column = std::floor(x_m / kTileM), row = std::floor(y_m / kTileM);
  const Tile& z = tile(static_cast<std::int64_t>(column), static_cast<std::int64_t>(row));
  const double x = (x_m - column * kTileM) / kSpacingM, y = (y_m - row * kTileM) / kSpacingM;
  const int i = std::min(static_cast<int>(x), kSquares - 1), j = std::min(static_cast<int>(y), kSquares - 1);
  const double u = x - i, v = y - j;
  const float* low = &z[static_cast<std::size_t>(j) * (kSquares + 1) + static_cast<std::size_t>(i)];
  const float* high = low + kSquares + 1;
  return (1.0 - v) * ((1.0 - u) * low[0] + u * low[1]) + v * ((1.0 - u) * high[0] + u * high[1]);
}

double TrueSurface::top_m(double x_m, double y_m, double side_m) {
  const int steps = std::max(1, static_cast<int>(std::ceil(side_m / kSpacingM - 1e-9)));
  const double step_m = side_m / steps;
  double top = -std::numeric_limits<double>::infinity();
  for (int j = 0; j <= steps; ++j)
    for (int i = 0; i <= steps; ++i) top = std::max(top, height_m(x_m + i * step_m, y_m + j * step_m));
  return top;
}

}  // namespace rover::truth
