#include "slam/elevation_map.hpp"

#include <algorithm>
#include <cmath>

namespace rover::slam {
namespace {

constexpr float kUnseen = std::numeric_limits<float>::quiet_NaN();
constexpr float kUnknownSlope = 0.3F;    // assumed if the cloud sees only one of two neighbouring cells
constexpr float kCellCoreShare = 0.35F;  // half width; a ray nearer to the border may miss the object in the cell
constexpr float kRayStartM = 0.3F;       // no clearing this close to the camera

}  // namespace

float ElevationMap::variance_m2(const ElevationCell& cell, double travelled_m) const {
  return cell.variance_m2 + static_cast<float>(config_.growth_m2_per_m * std::max(0.0, travelled_m - cell.seen_at_m));
}

int ElevationMap::seen_cells() const {
  int seen = 0;
  grid_.for_each([&](CellIndex, const ElevationCell& cell) { seen += cell.seen() ? 1 : 0; });
  return seen;
}

size_t ElevationMap::cell_offset(CellIndex i) const {
  const CellIndex origin = grid_.origin();
  return static_cast<size_t>(i.iy - origin.iy) * grid_.cells() + (i.ix - origin.ix);
}

void ElevationMap::insert(const AlignedCloud& cloud, const CloudPose& pose) {
  const std::vector<Patch>& patches = binner_.bin_cloud(cloud, pose.planar);
  store_cloud_heights(patches);
  const auto c = static_cast<float>(std::cos(pose.planar.yaw_rad)),
             s = static_cast<float>(std::sin(pose.planar.yaw_rad));
  const Eigen::Vector3f& m = cloud.camera_m;
  clear_along_rays({c * m.x() - s * m.y(), s * m.x() + c * m.y(), m.z()}, patches, pose);
  for (const Patch& patch : patches)
    if (const CellIndex i{patch.ix, patch.iy}; grid_.contains(i)) fuse(grid_.at(i), patch, pose);
}

void ElevationMap::store_cloud_heights(const std::vector<Patch>& patches) {
  const size_t size = static_cast<size_t>(grid_.cells()) * grid_.cells();
  new_height_m_.assign(size, kUnseen);
  for (const Patch& patch : patches)
    if (const CellIndex i{patch.ix, patch.iy}; grid_.contains(i)) new_height_m_[cell_offset(i)] = patch.z_m;
}

// Cells whose surface the cloud sees are updated by fuse() instead.
void ElevationMap::clear_along_rays(const Eigen::Vector3f& camera_m, const std::vector<Patch>& patches,
                                    const CloudPose& pose) {
  rays_through_.assign(new_height_m_.size(), 0);
  for (const Patch& patch : patches) trace_ray(camera_m, patch, pose);
  grid_.for_each([&](CellIndex i, ElevationCell& cell) {
    const size_t k = cell_offset(i);
    if (rays_through_[k] >= config_.clearing_rays && std::isnan(new_height_m_[k])) cell = ElevationCell{};
  });
}

void ElevationMap::trace_ray(const Eigen::Vector3f& camera_m, const Patch& patch, const CloudPose& pose) {
  const Eigen::Vector2f from = camera_m.head<2>(), ray = Eigen::Vector2f(patch.x_m, patch.y_m) - from;
  const float length = ray.norm();
  const auto ray_end_m =
      std::max(static_cast<float>(config_.ray_end_margin_m), 4.0F * std::hypot(patch.ray_x_m, patch.ray_y_m));
  const auto cell_m = static_cast<float>(grid_.cell_m()), per_cell = 1.0F / cell_m;
  const CellIndex corner = grid_.origin();
  const auto x0 = static_cast<float>(pose.planar.x_m - corner.ix * grid_.cell_m());
  const auto y0 = static_cast<float>(pose.planar.y_m - corner.iy * grid_.cell_m());
  const float drop_per_m = (patch.z_m - camera_m.z()) / length;
  for (float along = kRayStartM; along < length - ray_end_m; along += cell_m) {
    const float x = (x0 + from.x() + ray.x() * along / length) * per_cell;
    const float y = (y0 + from.y() + ray.y() * along / length) * per_cell;
    const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
    if (column < 0 || row < 0 || column >= grid_.cells() || row >= grid_.cells()) return;
    const auto from_center = [](float v, int whole) { return std::abs(v - static_cast<float>(whole) - 0.5F); };
    if (from_center(x, column) > kCellCoreShare || from_center(y, row) > kCellCoreShare) continue;
    const ElevationCell& cell = grid_.at({corner.ix + column, corner.iy + row});
    if (!cell.seen()) continue;
    const auto ray_m = static_cast<float>(pose.z_m) + camera_m.z() + drop_per_m * along;
    const float above = cell.top_m - ray_m - static_cast<float>(config_.clearing_margin_m);
    if (above <= 0.0F || above * above < 4.0F * variance_m2(cell, pose.travelled_m)) continue;
    std::uint8_t& count = rays_through_[static_cast<size_t>(row) * grid_.cells() + column];
    if (count < 255) ++count;
  }
}

// Slope of the cloud's own surface along (dx, dy), central difference where possible.
float ElevationMap::slope_along(CellIndex i, int dx, int dy) const {
  const auto at = [&](int sign) {
    const CellIndex k{i.ix + sign * dx, i.iy + sign * dy};
    return grid_.contains(k) ? new_height_m_[cell_offset(k)] : kUnseen;
  };
  const float before = at(-1), here = at(0), after = at(1);
  const auto cell_m = static_cast<float>(grid_.cell_m());
  if (!std::isnan(before) && !std::isnan(after)) return (after - before) / (2.0F * cell_m);
  if (!std::isnan(after)) return (after - here) / cell_m;
  if (!std::isnan(before)) return (here - before) / cell_m;
  return kUnknownSlope;
}

// On a slope, an error along the ray also changes the height.
float ElevationMap::measured_variance_m2(const Patch& patch) const {
  const CellIndex i{patch.ix, patch.iy};
  const float by_slope = slope_along(i, 1, 0) * patch.ray_x_m + slope_along(i, 0, 1) * patch.ray_y_m;
  return patch.variance_m2 + by_slope * by_slope;
}

void ElevationMap::fuse(ElevationCell& cell, const Patch& patch, const CloudPose& pose) const {
  const auto z = static_cast<float>(pose.z_m) + patch.z_m;
  const float R = measured_variance_m2(patch);
  const auto floor2 = static_cast<float>(config_.min_sigma_m * config_.min_sigma_m);
  const float top = static_cast<float>(pose.z_m) + patch.top_m;
  const ElevationCell fresh{z, top, std::max(R, floor2), static_cast<float>(pose.travelled_m), 0, patch.brightness};
  if (!cell.seen()) {
    cell = fresh;
    return;
  }
  const float P = variance_m2(cell, pose.travelled_m), innovation = z - cell.height_m;
  const auto gate2 = static_cast<float>(config_.gate_sigma * config_.gate_sigma);
  if (innovation * innovation > gate2 * (P + R)) {
    // Replace the old height if the new one is more precise, or after a second outlier in a row.
    if (cell.outliers > 0 || R <= P)
      cell = fresh;
    else
      ++cell.outliers;
    return;
  }
  const float K = P / (P + R);
  cell.height_m += K * innovation;
  cell.top_m += K * (top - cell.top_m);
  cell.variance_m2 = std::max((1.0F - K) * P, floor2);
  cell.seen_at_m = static_cast<float>(pose.travelled_m);
  cell.outliers = 0;
  if (std::isnan(cell.brightness)) cell.brightness = patch.brightness;
  if (!std::isnan(patch.brightness)) cell.brightness += K * (patch.brightness - cell.brightness);
}

}  // namespace rover::slam
