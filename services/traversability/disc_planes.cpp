#include "traversability/disc_planes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rover::trav {
namespace {

enum Sum { kOne, kX, kXX, kZ, kXZ, kZZ, kY, kYY, kXY, kYZ };

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

}  // namespace

DiscPlanes::DiscPlanes(const GridShape& shape, const PlaneConfig& config)
    : shape_(shape), config_(config), reach_(static_cast<int>(std::floor(config.radius_m / shape.cell_m))) {
  int cells = 0;
  for (int dy = -reach_; dy <= reach_; ++dy) {
    const double r = config.radius_m / shape.cell_m;
    half_.push_back(static_cast<int>(std::floor(std::sqrt(r * r - dy * dy))));
    cells += 2 * half_.back() + 1;
  }
  min_cells_ = std::max(3, static_cast<int>(std::ceil(config.min_seen_fraction * cells)));
  stride_ = static_cast<std::size_t>(shape.cells_x + 2 * reach_ + 1);
  rows_.resize(static_cast<std::size_t>(shape.cells_y) * kMoments * stride_);
  sums_.resize(static_cast<std::size_t>(shape.cells_x) * kSums);
  planes_.resize(shape.size());
  count_.resize(shape.size());
}

const double* DiscPlanes::row(int iy, int moment) const {
  return rows_.data() + (static_cast<std::size_t>(iy) * kMoments + static_cast<std::size_t>(moment)) * stride_;
}

void DiscPlanes::fit(const std::vector<float>& height_m, const std::vector<std::uint8_t>& mask) {
  std::fill(planes_.begin(), planes_.end(), DiscPlane{kNan, kNan, kNan, kNan});
  refit(height_m, mask);
}

void DiscPlanes::refit(const std::vector<float>& height_m, const std::vector<std::uint8_t>& mask) {
  const auto first = std::find(mask.begin(), mask.end(), 1);
  // Relative to one of the heights, to keep the squares small.
  const double datum_m = first == mask.end() ? 0.0 : height_m[static_cast<std::size_t>(first - mask.begin())];
  sum_rows(height_m, mask, datum_m);
  for (int iy = 0; iy < shape_.cells_y; ++iy) {
    sum_discs(iy);
    solve(iy, datum_m);
  }
}

// Entry j of a row: sum over the cells before column j - reach_.
void DiscPlanes::sum_rows(const std::vector<float>& height_m, const std::vector<std::uint8_t>& mask, double datum_m) {
  for (int iy = 0; iy < shape_.cells_y; ++iy) {
    double sum[kMoments] = {};
    double* out = rows_.data() + static_cast<std::size_t>(iy) * kMoments * stride_;
    for (int j = 0; j < static_cast<int>(stride_); ++j) {
      for (int k = 0; k < kMoments; ++k)
        out[static_cast<std::size_t>(k) * stride_ + static_cast<std::size_t>(j)] = sum[k];
      const int ix = j - reach_;
      if (ix < 0 || ix >= shape_.cells_x || !mask[shape_.at(ix, iy)]) continue;
      const double x = ix, z = height_m[shape_.at(ix, iy)] - datum_m;
      const double moment[kMoments] = {1.0, x, x * x, z, x * z, z * z};
      for (int k = 0; k < kMoments; ++k) sum[k] += moment[k];
    }
  }
}

void DiscPlanes::sum_discs(int iy) {
  std::fill(sums_.begin(), sums_.end(), 0.0);
  for (int dy = std::max(-reach_, -iy); dy <= std::min(reach_, shape_.cells_y - 1 - iy); ++dy) {
    for (int k = 0; k < kMoments; ++k) add_row(iy + dy, k, k, 1.0, dy);
    add_row(iy + dy, kOne, kY, dy, dy);
    add_row(iy + dy, kOne, kYY, dy * dy, dy);
    add_row(iy + dy, kX, kXY, dy, dy);
    add_row(iy + dy, kZ, kYZ, dy, dy);
  }
}

void DiscPlanes::add_row(int iy, int moment, int sum, double factor, int dy) {
  const int half = half_[static_cast<std::size_t>(dy + reach_)];
  const double* low = row(iy, moment) + (reach_ - half);
  const double* high = row(iy, moment) + (reach_ + half + 1);
  double* out = sums_.data() + static_cast<std::size_t>(sum) * static_cast<std::size_t>(shape_.cells_x);
  for (int ix = 0; ix < shape_.cells_x; ++ix) out[ix] += factor * (high[ix] - low[ix]);
}

// In cells, y relative to the cell itself; the resulting slopes are per metre.
void DiscPlanes::solve(int iy, double datum_m) {
  const std::size_t n_x = static_cast<std::size_t>(shape_.cells_x);
  const double min_variance = std::pow(config_.min_spread_m / shape_.cell_m, 2);
  for (int ix = 0; ix < shape_.cells_x; ++ix) {
    const auto sum = [&](int k) { return sums_[static_cast<std::size_t>(k) * n_x + static_cast<std::size_t>(ix)]; };
    const double n = sum(kOne);
    DiscPlane& plane = planes_[shape_.at(ix, iy)];
    count_[shape_.at(ix, iy)] = static_cast<int>(n);
    if (n < min_cells_) continue;
    const double x = sum(kX) / n, y = sum(kY) / n, z = sum(kZ) / n;
    const double xx = sum(kXX) / n - x * x, yy = sum(kYY) / n - y * y, xy = sum(kXY) / n - x * y;
    const double min_eigenvalue = 0.5 * (xx + yy) - std::sqrt(0.25 * (xx - yy) * (xx - yy) + xy * xy);
    if (min_eigenvalue < min_variance) continue;
    const double xz = sum(kXZ) / n - x * z, yz = sum(kYZ) / n - y * z, zz = sum(kZZ) / n - z * z;
    const double determinant = xx * yy - xy * xy;
    const double a = (yy * xz - xy * yz) / determinant, b = (xx * yz - xy * xz) / determinant;
    plane.slope_x = static_cast<float>(a / shape_.cell_m);
    plane.slope_y = static_cast<float>(b / shape_.cell_m);
    plane.height_m = static_cast<float>(datum_m + z + a * (ix - x) - b * y);
    plane.rms_m = static_cast<float>(std::sqrt(std::max(0.0, zz - a * xz - b * yz)));
  }
}

}  // namespace rover::trav
