#include "tools/report/true_relief.hpp"

#include <algorithm>

#include "tools/report/rock_evaluation.hpp"

namespace rover::report {
namespace {

constexpr double kCellM = 0.05;
constexpr int kSamples = 2;  // of the surface in a cell, in each direction
constexpr int kSide = oracle::TiledGrid<ReliefCell>::kSide;

}  // namespace

TrueRelief::TrueRelief(const TrueWorld& world)
    : world_(world),
      ground_(world.ground_m),
      cells_(kCellM, [this](int ix, int iy, std::vector<ReliefCell>& tile) { fill(ix, iy, tile); }) {}

void TrueRelief::fill(int ix, int iy, std::vector<ReliefCell>& tile) {
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const double ground_m = ground_.at((ix + i + 0.5) * kCellM, (iy + j + 0.5) * kCellM);
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
