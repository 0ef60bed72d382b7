#include "tools/hazard_calibrate/calibrate.hpp"

#include <algorithm>
#include <cmath>
#include <nlopt.hpp>

#include "common/core/disparity_plane.hpp"

namespace rover::hazard {
namespace {

struct Observation {
  double u, v, px;
};

struct Problem {
  const StereoCamera& camera;
  double origin_height_m;
  const std::vector<Observation>& observations;
  double scale_px = 1.0;

  DisparityPlane model(const std::vector<double>& x) const {
    const StereoCamera at = calibrated_camera(camera, {x[0], x[1], x[2]}, origin_height_m);
    return disparity_plane(at, {0, 0, -origin_height_m}, Eigen::Vector3d::UnitZ());
  }
};

// Mean Cauchy loss.
double cost(const std::vector<double>& x, std::vector<double>&, void* data) {
  const Problem& problem = *static_cast<const Problem*>(data);
  const DisparityPlane plane = problem.model(x);
  double sum = 0.0;
  for (const Observation& o : problem.observations) {
    const double s = (o.px - plane.at(o.u, o.v)) / problem.scale_px;
    sum += std::log1p(s * s);
  }
  return sum / static_cast<double>(problem.observations.size());
}

std::vector<double> minimise(Problem& problem, const std::vector<double>& start, const CalibrateConfig& config) {
  const std::vector<double> range{config.max_height_change_m, config.max_angle_change_rad, config.max_angle_change_rad};
  std::vector<double> low = start, high = start, x = start;
  for (size_t i = 0; i < 3; ++i) {
    low[i] -= range[i];
    high[i] += range[i];
  }
  for (double scale : config.scales_px) {
    problem.scale_px = scale;
    nlopt::opt optimiser(nlopt::LN_BOBYQA, 3);
    optimiser.set_min_objective(cost, &problem);
    optimiser.set_lower_bounds(low);
    optimiser.set_upper_bounds(high);
    optimiser.set_initial_step({0.01, 0.01, 0.01});
    optimiser.set_xtol_abs(std::vector<double>{1e-5, 1e-6, 1e-6});
    optimiser.set_maxeval(500);
    double value = 0.0;
    optimiser.optimize(x, value);
  }
  return x;
}

}  // namespace

bool CalibrationFrames::add(const Disparity& disparity, const StereoCamera& camera) {
  if (frames_ == 0) {
    camera_ = camera;
    sum_px_.assign(disparity.px16.size(), 0.0);
    count_.assign(disparity.px16.size(), 0);
  }
  if (!camera.same_optics(camera_) || disparity.px16.size() != sum_px_.size()) return false;
  for (size_t i = 0; i < sum_px_.size(); ++i) {
    if (disparity.px16[i] <= 0) continue;
    sum_px_[i] += disparity.px16[i] / 16.0;
    ++count_[i];
  }
  ++frames_;
  return true;
}

CalibrationFit CalibrationFrames::fit(double origin_height_m) const {
  std::vector<Observation> observations;
  for (int v = 0; v < camera_.height; v += config_.step_px)
    for (int u = 0; u < camera_.width; u += config_.step_px) {
      const size_t i = static_cast<size_t>(v) * camera_.width + u;
      if (2 * count_[i] >= frames_ && count_[i] > 0)
        observations.push_back({double(u), double(v), sum_px_[i] / count_[i]});
    }
  CalibrationFit fit;
  fit.pixels = static_cast<int>(observations.size());
  if (fit.pixels < config_.min_pixels) {
    fit.failure = "too few pixels with stereo";
    return fit;
  }
  const GroundCalibration start = nominal_calibration(camera_, origin_height_m);
  Problem problem{camera_, origin_height_m, observations};
  const std::vector<double> x = minimise(problem, {start.height_m, start.pitch_rad, start.roll_rad}, config_);
  const DisparityPlane plane = problem.model(x);
  double squares = 0.0;
  int inliers = 0;
  for (const Observation& o : observations) {
    const double residual = o.px - plane.at(o.u, o.v);
    if (std::abs(residual) > config_.inlier_px) continue;
    squares += residual * residual;
    ++inliers;
  }
  fit.calibration = {x[0], x[1], x[2]};
  fit.inlier_fraction = static_cast<double>(inliers) / fit.pixels;
  fit.rms_px = std::sqrt(squares / std::max(1, inliers));
  fit.ok = fit.inlier_fraction >= config_.min_inlier_fraction;
  if (!fit.ok) fit.failure = "the ground is not flat enough";
  return fit;
}

}  // namespace rover::hazard
