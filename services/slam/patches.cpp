#include "slam/patches.hpp"

#include <algorithm>
#include <cmath>

namespace rover::slam {
namespace {

constexpr int kMinUpperPoints = 2;  // a single high point is more likely an outlier

}  // namespace

PatchBinner::PatchBinner(const PatchConfig& config)
    : config_(config), cells_(2 * static_cast<int>(std::ceil(config.max_range_m / config.cell_m)) + 1) {}

void PatchBinner::Sums::add(const AlignedPoint& point, float px, float py) {
  const float w = 1.0F / point.variance_m2;
  weight += w;
  x += w * px;
  y += w * py;
  z += w * point.z_m;
  ray_x += point.ray_x_m;
  ray_y += point.ray_y_m;
  variance += point.variance_m2;
  brightness += point.brightness;
  ++count;
}

void PatchBinner::assign_bins(const AlignedCloud& cloud, const Pose2& pose) {
  const auto cell = config_.cell_m;
  origin_x_ = static_cast<int>(std::floor(pose.x_m / cell)) - cells_ / 2;
  origin_y_ = static_cast<int>(std::floor(pose.y_m / cell)) - cells_ / 2;
  // Relative to the window's corner, so that float precision suffices anywhere in the world.
  const auto x0 = static_cast<float>(pose.x_m - origin_x_ * cell), y0 = static_cast<float>(pose.y_m - origin_y_ * cell);
  cos_ = static_cast<float>(std::cos(pose.yaw_rad));
  sin_ = static_cast<float>(std::sin(pose.yaw_rad));
  const auto per_cell = static_cast<float>(1.0 / cell);
  bins_.assign(static_cast<size_t>(cells_) * cells_, Bin{1e9F, -1e9F, 0.0F, 0, {}, 0.0F, 0.0F, 0});
  const size_t n = cloud.points.size();
  bin_of_.assign(n, -1);
  x_m_.resize(n);
  y_m_.resize(n);
  for (size_t i = 0; i < n; ++i) {
    const AlignedPoint& p = cloud.points[i];
    x_m_[i] = cos_ * p.x_m - sin_ * p.y_m;
    y_m_[i] = sin_ * p.x_m + cos_ * p.y_m;
    const int ix = static_cast<int>(std::floor((x0 + x_m_[i]) * per_cell));
    const int iy = static_cast<int>(std::floor((y0 + y_m_[i]) * per_cell));
    if (ix < 0 || iy < 0 || ix >= cells_ || iy >= cells_) continue;
    bin_of_[i] = iy * cells_ + ix;
    Bin& bin = bins_[static_cast<size_t>(bin_of_[i])];
    bin.lowest = std::min(bin.lowest, p.z_m);
    bin.highest = std::max(bin.highest, p.z_m);
    bin.variance += p.variance_m2;
    ++bin.count;
  }
}

bool PatchBinner::is_step(const Bin& bin) const {
  const float spread = bin.highest - bin.lowest;
  const auto noise = 16.0F * bin.variance / static_cast<float>(bin.count);  // (4 sigma)^2
  return spread > static_cast<float>(config_.step_m) && spread * spread > noise;
}

Patch PatchBinner::patch_of(const Bin& bin, int column, int row) const {
  const bool step = is_step(bin) && bin.upper_count >= kMinUpperPoints;
  const Sums& sums = bin.all;
  const auto n = static_cast<float>(sums.count);
  const float independent = std::min(n, static_cast<float>(config_.correlated_points));
  const auto rough = static_cast<float>(config_.roughness_m * config_.roughness_m);
  const float shrink = 1.0F / std::sqrt(independent);
  Patch patch;
  patch.ix = origin_x_ + column;
  patch.iy = origin_y_ + row;
  patch.x_m = sums.x / sums.weight;
  patch.y_m = sums.y / sums.weight;
  patch.z_m = sums.z / sums.weight;
  patch.variance_m2 = sums.variance / n / independent + rough / n;
  patch.ray_x_m = (cos_ * sums.ray_x - sin_ * sums.ray_y) / n * shrink;
  patch.ray_y_m = (sin_ * sums.ray_x + cos_ * sums.ray_y) / n * shrink;
  patch.brightness = sums.brightness / n;
  patch.top_m = step ? bin.upper_z / bin.upper_weight : patch.z_m;
  // The position of a step inside the cell is unknown.
  if (step) patch.variance_m2 += 0.01F * (bin.highest - bin.lowest) * (bin.highest - bin.lowest);
  return patch;
}

const std::vector<Patch>& PatchBinner::bin_cloud(const AlignedCloud& cloud, const Pose2& pose) {
  assign_bins(cloud, pose);
  for (size_t i = 0; i < cloud.points.size(); ++i) {
    if (bin_of_[i] < 0) continue;
    Bin& bin = bins_[static_cast<size_t>(bin_of_[i])];
    const AlignedPoint& p = cloud.points[i];
    bin.all.add(p, x_m_[i], y_m_[i]);
    if (p.z_m <= 0.5F * (bin.lowest + bin.highest)) continue;
    bin.upper_weight += 1.0F / p.variance_m2;
    bin.upper_z += p.z_m / p.variance_m2;
    ++bin.upper_count;
  }
  patches_.clear();
  for (int row = 0; row < cells_; ++row)
    for (int column = 0; column < cells_; ++column)
      if (const Bin& bin = bins_[static_cast<size_t>(row) * cells_ + column]; bin.count > 0)
        patches_.push_back(patch_of(bin, column, row));
  return patches_;
}

}  // namespace rover::slam
