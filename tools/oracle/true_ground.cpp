#include "tools/oracle/true_ground.hpp"

#include <algorithm>
#include <array>

namespace rover::oracle {
namespace {

constexpr int kBlockCells = 10;

}  // namespace

float TrueGround::height(int ix, int iy) {
  Height& cell = heights_.at(ix, iy);
  if (cell.m == kUnknown) cell.m = static_cast<float>(height_m_(heights_.center_m(ix), heights_.center_m(iy)));
  return cell.m;
}

double TrueGround::slope_rad(double x_m, double y_m) {
  Block& block = blocks_.at_point(x_m, y_m);
  if (block.slope_rad == kUnknown) {
    const double x = blocks_.center_m(blocks_.index_of(x_m));
    const double y = blocks_.center_m(blocks_.index_of(y_m));
    const double reach_m = config_.half_wheelbase_m;
    const double rise_x = ground_.at(x + reach_m, y) - ground_.at(x - reach_m, y);
    const double rise_y = ground_.at(x, y + reach_m) - ground_.at(x, y - reach_m);
    block.slope_rad = static_cast<float>(std::atan(std::hypot(rise_x, rise_y) / (2.0 * reach_m)));
  }
  return block.slope_rad;
}

const std::vector<Hazard>& TrueGround::hazards(int bx, int by) {
  Block& block = blocks_.at(bx, by);
  if (!block.classified) classify(bx, by, block);
  return block.hazards;
}

void TrueGround::classify(int bx, int by, Block& block) {
  constexpr int kSide = kBlockCells + 2;  // with a border
  std::array<std::array<float, kSide>, kSide> rise;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const int ix = bx * kBlockCells + x - 1;
      const int iy = by * kBlockCells + y - 1;
      rise[y][x] = height(ix, iy) - static_cast<float>(ground_.at(heights_.center_m(ix), heights_.center_m(iy)));
    }
  for (int y = 1; y <= kBlockCells; ++y)
    for (int x = 1; x <= kBlockCells; ++x) {
      const float lowest = std::min({rise[y - 1][x], rise[y + 1][x], rise[y][x - 1], rise[y][x + 1]});
      const auto is_rim = [&](double limit_m) { return rise[y][x] >= limit_m && lowest < limit_m; };
      const double x_m = heights_.center_m(bx * kBlockCells + x - 1);
      const double y_m = heights_.center_m(by * kBlockCells + y - 1);
      const bool body = is_rim(config_.body_limit_m) || forbidding_zone(config_.zones, {x_m, y_m}) != nullptr;
      if (body || is_rim(config_.wheel_limit_m))
        block.hazards.push_back({static_cast<float>(x_m), static_cast<float>(y_m), body});
    }
  block.classified = true;
}

}  // namespace rover::oracle
