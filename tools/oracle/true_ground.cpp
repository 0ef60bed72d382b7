#include "tools/oracle/true_ground.hpp"

#include <algorithm>
#include <array>

namespace rover::oracle {
namespace {

constexpr int kBlockCells = 10;
constexpr int kNodeCells = 5;  // between nodes of the local ground: a ledge lies at most a quarter metre from one
constexpr int kSampleStep = 2;

float quantile(std::vector<float>& values, double q) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

constexpr int kReachBlocks = 3;
constexpr size_t kDifferences = (2 * kReachBlocks + 1) * (2 * kReachBlocks - 1);

float median_of(std::array<float, kDifferences>& values) {
  const auto middle = values.begin() + values.size() / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

int floor_div(int a, int b) {
  return a >= 0 ? a / b : -((b - 1 - a) / b);
}

}  // namespace

TrueGround::TrueGround(HeightFunction height_m, const GroundConfig& config, double x0_m, double y0_m, double x1_m,
                       double y1_m)
    : height_m_(std::move(height_m)),
      config_(config),
      heights_(kCellM, x0_m - kReachM, y0_m - kReachM, x1_m + kReachM, y1_m + kReachM),
      nodes_(kCellM * kNodeCells, x0_m - kReachM, y0_m - kReachM, x1_m + kReachM, y1_m + kReachM),
      blocks_(kBlockM, x0_m - kReachM, y0_m - kReachM, x1_m + kReachM, y1_m + kReachM) {}

float TrueGround::height(int ix, int iy) {
  Height& cell = heights_.at(ix, iy);
  if (cell.m == kUnknown) cell.m = static_cast<float>(height_m_(heights_.centre_m(ix), heights_.centre_m(iy)));
  return cell.m;
}

// A quantile, so that a rock does not tilt the slope.
float TrueGround::block_low(int bx, int by) {
  Block& block = blocks_.at(bx, by);
  if (block.low_m != kUnknown) return block.low_m;
  samples_.clear();
  for (int y = 0; y < kBlockCells; y += kSampleStep)
    for (int x = 0; x < kBlockCells; x += kSampleStep)
      samples_.push_back(height(bx * kBlockCells + x, by * kBlockCells + y));
  return block.low_m = quantile(samples_, 0.25);
}

// Median of the differences between blocks one metre apart, over 3.5 m: a ledge is in two of five, a rock in fewer.
TrueGround::Gradient TrueGround::gradient(int bx, int by) {
  Block& block = blocks_.at(bx, by);
  if (block.gradient.x != kUnknown) return block.gradient;
  std::array<float, kDifferences> along_x{};
  std::array<float, kDifferences> along_y{};
  size_t n = 0;
  for (int a = -kReachBlocks; a <= kReachBlocks; ++a)
    for (int b = -kReachBlocks; b + 2 <= kReachBlocks; ++b, ++n) {
      along_x[n] = block_low(bx + b + 2, by + a) - block_low(bx + b, by + a);
      along_y[n] = block_low(bx + a, by + b + 2) - block_low(bx + a, by + b);
    }
  constexpr auto kBaseM = static_cast<float>(2.0 * kBlockM);
  return block.gradient = {median_of(along_x) / kBaseM, median_of(along_y) / kBaseM};
}

// The mean of the bare ground, extrapolated from two low quantiles of a normal distribution (at -0.67 and -1.64 sigma):
// rocks and the upper side of a ledge are in the upper part of the heights.
float TrueGround::node(int nx, int ny) {
  Height& cell = nodes_.at(nx, ny);
  if (cell.m != kUnknown) return cell.m;
  const int cx = nx * kNodeCells;
  const int cy = ny * kNodeCells;
  const Gradient slope = gradient(floor_div(cx, kBlockCells), floor_div(cy, kBlockCells));
  const int half = static_cast<int>(config_.window_m / kCellM);
  samples_.clear();
  for (int dy = -half; dy <= half; dy += kSampleStep)
    for (int dx = -half; dx <= half; dx += kSampleStep) {
      const auto x_m = static_cast<float>((dx + 0.5) * kCellM);
      const auto y_m = static_cast<float>((dy + 0.5) * kCellM);
      samples_.push_back(height(cx + dx, cy + dy) - slope.x * x_m - slope.y * y_m);
    }
  const float q25 = quantile(samples_, 0.25);
  const float q05 = quantile(samples_, 0.05);
  return cell.m = q25 + 0.69F * (q25 - q05);
}

double TrueGround::local_ground_m(double x_m, double y_m) {
  const double u = x_m / nodes_.cell_m();
  const double v = y_m / nodes_.cell_m();
  const int nx = static_cast<int>(std::floor(u));
  const int ny = static_cast<int>(std::floor(v));
  return std::lerp(std::lerp(node(nx, ny), node(nx + 1, ny), u - nx),
                   std::lerp(node(nx, ny + 1), node(nx + 1, ny + 1), u - nx), v - ny);
}

double TrueGround::slope_rad(double x_m, double y_m) {
  const int bx = blocks_.index(x_m);
  const int by = blocks_.index(y_m);
  Block& block = blocks_.at(bx, by);
  if (block.slope_rad == kUnknown) {
    const double x = blocks_.centre_m(bx);
    const double y = blocks_.centre_m(by);
    const double reach_m = config_.window_m;
    const double rise_x = local_ground_m(x + reach_m, y) - local_ground_m(x - reach_m, y);
    const double rise_y = local_ground_m(x, y + reach_m) - local_ground_m(x, y - reach_m);
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
      rise[y][x] = height(ix, iy) - static_cast<float>(local_ground_m(heights_.centre_m(ix), heights_.centre_m(iy)));
    }
  for (int y = 1; y <= kBlockCells; ++y)
    for (int x = 1; x <= kBlockCells; ++x) {
      const float lowest = std::min({rise[y - 1][x], rise[y + 1][x], rise[y][x - 1], rise[y][x + 1]});
      const auto is_rim = [&](double limit_m) { return rise[y][x] >= limit_m && lowest < limit_m; };
      const bool body = is_rim(config_.body_limit_m);
      if (body || is_rim(config_.wheel_limit_m))
        block.hazards.push_back({static_cast<float>(heights_.centre_m(bx * kBlockCells + x - 1)),
                                 static_cast<float>(heights_.centre_m(by * kBlockCells + y - 1)), body});
    }
  block.classified = true;
}

}  // namespace rover::oracle
