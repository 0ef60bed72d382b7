#include "hazard_detector/hazard_detector.hpp"

#include <algorithm>
#include <cmath>

#include "common/core/check.hpp"

namespace rover::hazard {
namespace {

constexpr double kNoiseCoverage = 0.05;  // below, what matches is noise: a fogged lens gives 0.001

bool same_camera(const StereoCamera& a, const StereoCamera& b) {
  return a.same_optics(b) && a.T_body_cam.matrix() == b.T_body_cam.matrix();
}

// Cell index of a point, -1 outside the grid.
struct CellLookup {
  float origin_x, origin_y, per_m;
  int cells_x, cells_y;

  explicit CellLookup(const GridShape& s)
      : origin_x(static_cast<float>(s.origin_x_m)),
        origin_y(static_cast<float>(s.origin_y_m)),
        per_m(static_cast<float>(1.0 / s.cell_m)),
        cells_x(s.cells_x),
        cells_y(s.cells_y) {}

  int operator()(float x, float y) const {
    const float fx = (x - origin_x) * per_m, fy = (y - origin_y) * per_m;
    if (!(fx >= 0.0f && fy >= 0.0f && fx < static_cast<float>(cells_x) && fy < static_cast<float>(cells_y))) return -1;
    return static_cast<int>(fy) * cells_x + static_cast<int>(fx);
  }
};

// Limits of one cell as factors h / (h - height) on the disparity of the reference plane.
struct LimitFactors {
  float high, tall, raised, low;
};

float limit_factor(double camera_height_m, double height_m) {
  return static_cast<float>(camera_height_m / std::max(0.05, camera_height_m - height_m));
}

}  // namespace

HazardDetector::HazardDetector(const HazardConfig& config)
    : config_(config), shape_(config.grid), evidence_(static_cast<size_t>(shape_.size())) {}

HazardResult HazardDetector::step(const Disparity& disparity, const StereoCamera& camera) {
  ROVER_CHECK(disparity.width == camera.width && disparity.height == camera.height, disparity.width, camera.width);
  update_table(camera);
  HazardResult result;
  result.coverage = accumulate_samples(disparity);
  if (result.coverage < kNoiseCoverage) {
    std::fill(evidence_.begin(), evidence_.end(), CellEvidence{});
    std::fill(cell_of_sample_.begin(), cell_of_sample_.end(), std::int16_t{-1});
  }
  result.plane = fit_plane(evidence_, shape_, config_);
  classify_samples(disparity, result.plane, fit_local_ground(evidence_, shape_, config_, result.plane));
  result.cells = classify_cells(evidence_, shape_, config_);
  summarize(evidence_, shape_, result);
  if (result.coverage < config_.min_coverage) result.status = Status::kBlind;
  return result;
}

void HazardDetector::update_table(const StereoCamera& camera) {
  std::fill(evidence_.begin(), evidence_.end(), CellEvidence{});
  if (table_ && same_camera(camera, camera_)) return;
  camera_ = camera;
  table_.emplace(
      config_.calibration ? calibrated_camera(camera, *config_.calibration, config_.origin_height_m) : camera, config_);
  cell_of_sample_.assign(table_->samples().size(), -1);
}

// Accumulates measured samples into cells; returns the stereo coverage of the region of interest.
double HazardDetector::accumulate_samples(const Disparity& disparity) {
  const StereoCamera& camera = table_->camera();
  const CellLookup lookup(shape_);
  const Eigen::Vector3f p_cam = camera.T_body_cam.translation().cast<float>();
  const float ground_z = p_cam.z() + static_cast<float>(config_.origin_height_m);
  const float depth_px16 = static_cast<float>(16.0 * camera.focal_px * camera.baseline_m);
  const std::vector<Sample>& samples = table_->samples();
  int roi = 0, roi_measured = 0;
  for (size_t k = 0; k < samples.size(); ++k) {
    const Sample& s = samples[k];
    const int d = disparity.px16[static_cast<size_t>(s.index)];
    roi += s.in_roi;
    cell_of_sample_[k] = -1;
    if (d <= 0) continue;
    roi_measured += s.in_roi;
    const float depth = depth_px16 / static_cast<float>(d);
    const int cell = lookup(p_cam.x() + depth * s.ray_x, p_cam.y() + depth * s.ray_y);
    if (cell < 0) continue;
    cell_of_sample_[k] = static_cast<std::int16_t>(cell);
    CellEvidence& e = evidence_[static_cast<size_t>(cell)];
    ++e.measured;
    e.sum_z_m += ground_z + depth * s.ray_z;
  }
  return roi > 0 ? static_cast<double>(roi_measured) / roi : 0.0;
}

GroundPlane fit_plane(const std::vector<CellEvidence>& evidence, const GridShape& shape, const HazardConfig& config) {
  GroundPoints points;
  for (int iy = 0; iy < shape.cells_y; ++iy)
    for (int ix = 0; ix < shape.cells_x; ++ix) {
      const CellEvidence& e = evidence[static_cast<size_t>(shape.at(ix, iy))];
      if (e.measured < config.min_free_samples) continue;
      points.push_back({static_cast<float>(shape.x_m(ix)), static_cast<float>(shape.y_m(iy)),
                        e.sum_z_m / static_cast<float>(e.measured)});
    }
  return fit_ground_plane(points, config.plane);
}

LocalGround fit_local_ground(const std::vector<CellEvidence>& evidence, const GridShape& shape,
                             const HazardConfig& config, const GroundPlane& plane) {
  std::vector<float> over_plane(evidence.size(), std::numeric_limits<float>::quiet_NaN());
  for (int iy = 0; iy < shape.cells_y; ++iy)
    for (int ix = 0; ix < shape.cells_x; ++ix) {
      const size_t i = static_cast<size_t>(shape.at(ix, iy));
      if (evidence[i].measured < config.min_free_samples) continue;
      const double plane_m = plane.offset_m + plane.slope_x * (shape.x_m(ix) - config.plane.front_axle_x_m) +
                             plane.slope_y * shape.y_m(iy);
      over_plane[i] = evidence[i].sum_z_m / static_cast<float>(evidence[i].measured) - static_cast<float>(plane_m);
    }
  return estimate_local_ground(over_plane, shape, config.local_ground, config.plane.front_axle_x_m);
}

// Compares each disparity with d_cal, corrected for the fitted plane, times the limit factors of its cell. Also counts
// the samples that would hit the ground of each cell.
void HazardDetector::classify_samples(const Disparity& disparity, const GroundPlane& plane, const LocalGround& ground) {
  const StereoCamera& camera = table_->camera();
  const Eigen::Vector3d normal = plane.normal();
  const Eigen::Vector3d p_plane(config_.plane.front_axle_x_m, 0.0, plane.offset_m - config_.origin_height_m);
  const double height_m = normal.dot(camera.T_body_cam.translation() - p_plane);
  const DisparityPlane fitted = disparity_plane(camera, p_plane, normal);
  const DisparityPlane& flat = table_->flat_ground();
  const float du = static_cast<float>(16.0 * (fitted.per_u - flat.per_u));
  const float dv = static_cast<float>(16.0 * (fitted.per_v - flat.per_v));
  const float d0 = static_cast<float>(16.0 * (fitted.at_origin_px - flat.at_origin_px));
  std::vector<LimitFactors> limits;
  limits.reserve(evidence_.size());
  for (size_t i = 0; i < evidence_.size(); ++i)
    limits.push_back({limit_factor(height_m, ground.low_m[i] + config_.obstacle_height_m),
                      limit_factor(height_m, ground.low_m[i] + config_.body_height_m),
                      limit_factor(height_m, ground.low_m[i] + config_.grow_height_m),
                      limit_factor(height_m, ground.high_m[i] - config_.hole_depth_m)});
  const CellLookup lookup(shape_);
  const Eigen::Vector3f p_cam = camera.T_body_cam.translation().cast<float>();
  const float depth_px16 = static_cast<float>(16.0 * camera.focal_px * camera.baseline_m);
  const float at_body_height = 1.0f / limit_factor(height_m, config_.body_height_m);
  const std::vector<Sample>& samples = table_->samples();
  for (size_t k = 0; k < samples.size(); ++k) {
    const Sample& s = samples[k];
    const float d = static_cast<float>(disparity.px16[static_cast<size_t>(s.index)]);
    const float reference = s.d_cal_px16 + d0 + du * s.u + dv * s.v;
    if (reference > 0.0f) {
      const auto cell_at = [&](float depth) {
        return lookup(p_cam.x() + depth * s.ray_x, p_cam.y() + depth * s.ray_y);
      };
      const int below = cell_at(depth_px16 / reference), over = cell_at(at_body_height * depth_px16 / reference);
      if (below >= 0) ++evidence_[static_cast<size_t>(below)].expected;
      if (over >= 0) {
        ++evidence_[static_cast<size_t>(over)].over;
        evidence_[static_cast<size_t>(over)].over_seen += d > 0;
      }
    }
    const int cell = cell_of_sample_[k];
    if (cell < 0) continue;
    const LimitFactors& l = limits[static_cast<size_t>(cell)];
    CellEvidence& e = evidence_[static_cast<size_t>(cell)];
    e.high += d > l.high * reference;
    e.tall += d > l.tall * reference;
    e.raised += d > l.raised * reference;
    e.low += d < l.low * reference;
  }
}

void summarize(const std::vector<CellEvidence>& evidence, const GridShape& shape, HazardResult& result) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (int iy = 0; iy < shape.cells_y; ++iy)
    for (int ix = 0; ix < shape.cells_x; ++ix) {
      const size_t i = static_cast<size_t>(shape.at(ix, iy));
      if (!is_hazard(result.cells[i])) continue;
      result.hazard_px += evidence[i].high + evidence[i].low;
      nearest_m = std::min(nearest_m, std::hypot(shape.x_m(ix), shape.y_m(iy)));
    }
  result.status = std::isfinite(nearest_m) ? Status::kHazard : Status::kClear;
  if (std::isfinite(nearest_m)) result.nearest_hazard_m = nearest_m;
}

}  // namespace rover::hazard
