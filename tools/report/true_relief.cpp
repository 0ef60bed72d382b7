#include "tools/report/true_relief.hpp"

#include <algorithm>

#include "tools/report/rock_evaluation.hpp"

namespace rover::report {
namespace {

constexpr double kCellM = 0.05;
constexpr int kSamples = 2;      // of the surface in a cell, in each direction
constexpr int kNodeCells = 4;    // local ground is computed every 0.2 m and interpolated
constexpr int kWindowNodes = 3;  // half side of the square over which it is averaged
constexpr int kSide = TiledGrid<ReliefCell>::kSide;
constexpr int kNodes = kSide / kNodeCells + 1;

// Local ground at the nodes of a tile.
class GroundNodes {
 public:
  GroundNodes(const TrueWorld& world, double x0_m, double y0_m) {
    constexpr int kRaw = kNodes + 2 * kWindowNodes;
    const double node_m = kNodeCells * kCellM;
    std::vector<double> raw(kRaw * kRaw);
    for (int j = 0; j < kRaw; ++j)
      for (int i = 0; i < kRaw; ++i)
        raw[static_cast<size_t>(j * kRaw + i)] =
            world.ground_m(x0_m + (i - kWindowNodes) * node_m, y0_m + (j - kWindowNodes) * node_m);
    for (int j = 0; j < kNodes; ++j)
      for (int i = 0; i < kNodes; ++i) mean_m_[static_cast<size_t>(j * kNodes + i)] = window_mean(raw, kRaw, i, j);
  }
  // At the centre of a cell of the tile.
  double at(int ix, int iy) const {
    const double u = (ix + 0.5) / kNodeCells, v = (iy + 0.5) / kNodeCells;
    const int i = static_cast<int>(u), j = static_cast<int>(v);
    const auto node = [&](int di, int dj) { return mean_m_[static_cast<size_t>((j + dj) * kNodes + i + di)]; };
    const double low = node(0, 0) + (u - i) * (node(1, 0) - node(0, 0));
    const double high = node(0, 1) + (u - i) * (node(1, 1) - node(0, 1));
    return low + (v - j) * (high - low);
  }

 private:
  static double window_mean(const std::vector<double>& raw, int columns, int i, int j) {
    double sum = 0.0;
    for (int dj = 0; dj <= 2 * kWindowNodes; ++dj)
      for (int di = 0; di <= 2 * kWindowNodes; ++di) sum += raw[static_cast<size_t>((j + dj) * columns + i + di)];
    return sum / ((2 * kWindowNodes + 1) * (2 * kWindowNodes + 1));
  }
  std::array<double, kNodes * kNodes> mean_m_{};
};

}  // namespace

TrueRelief::TrueRelief(const TrueWorld& world)
    : world_(world), cells_(kCellM, [this](int ix, int iy, std::vector<ReliefCell>& tile) { fill(ix, iy, tile); }) {}

void TrueRelief::fill(int ix, int iy, std::vector<ReliefCell>& tile) const {
  const GroundNodes ground(world_, ix * kCellM, iy * kCellM);
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const double ground_m = ground.at(i, j);
      double rise_m = -kInfinity;
      int tall = 0;
      for (int k = 0; k < kSamples * kSamples; ++k) {
        const double x_m = (ix + i + (k % kSamples + 0.5) / kSamples) * kCellM;
        const double y_m = (iy + j + (k / kSamples + 0.5) / kSamples) * kCellM;
        const double rise = world_.height_m(x_m, y_m) - ground_m;
        rise_m = std::max(rise_m, rise);
        tall += rise >= kHazardRockM ? 1 : 0;
      }
      tile[static_cast<size_t>(j * kSide + i)] = {static_cast<float>(ground_m), static_cast<float>(rise_m),
                                                  static_cast<float>(tall) / (kSamples * kSamples)};
    }
}

}  // namespace rover::report
