#include "tools/truth_perception/true_hazards.hpp"

#include <algorithm>
#include <cmath>

#include "common/core/frames.hpp"

namespace rover::truth {
namespace {

// The numbers of samples reject stereo outliers: a true surface has none.
hazard::HazardConfig without_noise(hazard::HazardConfig config) {
  config.min_cell_samples = config.min_cluster_samples = 1;
  return config;
}

// To the farthest corner of the grid.
double reach_m(const hazard::GridConfig& grid, const Eigen::Vector3d& p_body_cam) {
  return std::hypot(grid.max_x_m - p_body_cam.x(), grid.half_width_m + std::abs(p_body_cam.y()));
}

}  // namespace

TrueHazards::TrueHazards(const hazard::HazardConfig& config, const StereoCamera& camera,
                         std::shared_ptr<TrueSurface> surface)
    : config_(without_noise(config)), shape_(config.grid), camera_(camera), surface_(std::move(surface)) {}

// Every pixel below the horizon shows the surface, so the coverage is complete.
hazard::HazardResult TrueHazards::step(const Eigen::Isometry3d& T_map_body) {
  accumulate(T_map_body);
  hazard::HazardResult result;
  result.coverage = 1.0;
  result.plane = hazard::fit_plane(evidence_, shape_, config_);
  classify(result.plane, hazard::fit_local_ground(evidence_, shape_, config_, result.plane));
  result.cells = hazard::classify_cells(evidence_, shape_, config_);
  hazard::summarize(evidence_, shape_, result);
  return result;
}

// Visible points of the grid's cells.
void TrueHazards::accumulate(const Eigen::Isometry3d& T_map_body) {
  evidence_.assign(static_cast<std::size_t>(shape_.size()), {});
  const View view{.camera = camera_,
                  .T_map_cam = T_map_body * camera_.T_body_cam,
                  .max_depth_m = kInfinity,
                  .reach_m = reach_m(config_.grid, camera_.T_body_cam.translation())};
  const Eigen::Isometry3d T_body_map = T_map_body.inverse();
  find_points_in_view(*surface_, view, in_view_);
  seen_.clear();
  for (const SurfacePoint& point : in_view_) {
    const Eigen::Vector3d p_body = T_body_map * point.p_map;
    const int ix = static_cast<int>(std::floor((p_body.x() - shape_.origin_x_m) / shape_.cell_m));
    const int iy = static_cast<int>(std::floor((p_body.y() - shape_.origin_y_m) / shape_.cell_m));
    if (!shape_.contains(ix, iy)) continue;
    const int cell = shape_.at(ix, iy);
    hazard::CellEvidence& e = evidence_[static_cast<std::size_t>(cell)];
    ++e.expected;
    if (!point.visible) continue;
    ++e.measured;
    e.sum_z_m += static_cast<float>(p_body.z() + config_.origin_height_m);
    seen_.push_back({cell, p_body});
  }
}

// Heights are counted along the plane's normal, as those that disparities give.
void TrueHazards::classify(const hazard::GroundPlane& plane, const hazard::LocalGround& ground) {
  const Eigen::Vector3d normal = plane.normal();
  const Eigen::Vector3d p_plane(config_.plane.front_axle_x_m, 0.0, plane.offset_m - config_.origin_height_m);
  const View view{.camera = camera_, .max_depth_m = kInfinity};
  const Eigen::Isometry3d T_cam_body = camera_.T_body_cam.inverse();
  for (const SeenPoint& point : seen_) {
    const auto i = static_cast<std::size_t>(point.cell);
    const double height_m = normal.dot(point.p_body - p_plane);
    hazard::CellEvidence& e = evidence_[i];
    e.high += height_m > ground.low_m[i] + config_.obstacle_height_m;
    e.tall += height_m > ground.low_m[i] + config_.body_height_m;
    e.raised += height_m > ground.low_m[i] + config_.grow_height_m;
    e.low += height_m < ground.high_m[i] - config_.hole_depth_m;
    // A ray that passes here at the height of the body always meets a true surface.
    const Eigen::Vector3d over = point.p_body + (config_.body_height_m - height_m) * normal;
    const bool in_picture = in_both_images(view, T_cam_body * over);
    e.over += in_picture;
    e.over_seen += in_picture;
  }
}

}  // namespace rover::truth
