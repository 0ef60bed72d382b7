#include "slam/scan_match.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

namespace rover::slam {
namespace {

constexpr int kStartIterations = 6;

float square(float v) {
  return v * v;
}

}  // namespace

ScanMatcher::ToCells::ToCells(const MatchSurface& surface, const Pose2& pose) {
  const double per_cell = 1.0 / surface.cell_m();
  cos = static_cast<float>(std::cos(pose.yaw_rad) * per_cell);
  sin = static_cast<float>(std::sin(pose.yaw_rad) * per_cell);
  x = static_cast<float>((pose.x_m - surface.corner_x_m()) * per_cell);
  y = static_cast<float>((pose.y_m - surface.corner_y_m()) * per_cell);
}

void ScanMatcher::prepare(const std::vector<Patch>& patches, const MatchSurface& surface, const Pose2& reference) {
  surface_ = &surface;
  points_.clear();
  const ToCells to(surface, reference);
  const auto model2 = static_cast<float>(config_.model_sigma_m * config_.model_sigma_m);
  const auto blur = static_cast<float>(config_.horizontal_sigma_m);
  const size_t stride = 1 + patches.size() / static_cast<size_t>(config_.max_patches);
  for (size_t i = 0; i < patches.size(); i += stride) {
    const Patch& patch = patches[i];
    Point point{patch.x_m, patch.y_m, patch.z_m, 0.0F, 0.0F};
    if (std::hypot(patch.x_m, patch.y_m) > static_cast<float>(config_.max_range_m)) continue;
    const auto sample = surface.sample(to.u(point), to.v(point));
    if (!sample) continue;
    // Slope in the rover's axes.
    const auto c = static_cast<float>(std::cos(reference.yaw_rad)), s = static_cast<float>(std::sin(reference.yaw_rad));
    const float along = c * sample->slope_x + s * sample->slope_y, across = c * sample->slope_y - s * sample->slope_x;
    const float by_depth = along * patch.ray_x_m + across * patch.ray_y_m;
    const float by_blur2 = (square(along) + square(across)) * square(blur);
    point.weight = 1.0F / (patch.variance_m2 + sample->variance_m2 + model2 + square(by_depth) + by_blur2);
    points_.push_back(point);
  }
  start_plane_.setZero();
  if (points_.empty()) return;
  start_plane_ = fit(reference, kStartIterations).plane;
  const auto kernel2 = square(static_cast<float>(config_.kernel_sigma));
  for (size_t i = 0; i < points_.size(); ++i) {
    const float x = square(plane_residual(i, start_plane_)) * points_[i].weight;
    points_[i].off_map_cost = x / (kernel2 + x);
  }
}

void ScanMatcher::compute_residuals(const Pose2& pose) const {
  const ToCells to(*surface_, pose);
  residual_.resize(points_.size());
  for (size_t i = 0; i < points_.size(); ++i)
    residual_[i] = points_[i].z - surface_->height(to.u(points_[i]), to.v(points_[i]));
}

// One step of iteratively reweighted least squares.
Eigen::Vector3f ScanMatcher::refit_plane(const Eigen::Vector3f& from) const {
  const auto kernel2 = static_cast<float>(square(static_cast<float>(config_.kernel_sigma)));
  float s1 = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0, r1 = 0, rx = 0, ry = 0;
  for (size_t i = 0; i < points_.size(); ++i) {
    if (std::isnan(residual_[i])) continue;
    const Point& p = points_[i];
    const float kernel_weight = kernel2 / (kernel2 + square(plane_residual(i, from)) * p.weight);
    const float w = p.weight * kernel_weight * kernel_weight, wr = w * residual_[i];
    s1 += w, sx += w * p.x, sy += w * p.y;
    sxx += w * p.x * p.x, sxy += w * p.x * p.y, syy += w * p.y * p.y;
    r1 += wr, rx += wr * p.x, ry += wr * p.y;
  }
  const auto temper = static_cast<float>(config_.temper);
  Eigen::Matrix3f A;
  A << s1, sx, sy, sx, sxx, sxy, sy, sxy, syy;
  A *= temper;
  A(0, 0) += 1.0F / square(static_cast<float>(config_.height_sigma_m));
  A(1, 1) += 1.0F / square(static_cast<float>(config_.tilt_sigma_rad));
  A(2, 2) += 1.0F / square(static_cast<float>(config_.tilt_sigma_rad));
  return A.ldlt().solve(temper * Eigen::Vector3f(r1, rx, ry));
}

MatchFit ScanMatcher::evaluate(const Eigen::Vector3f& plane) const {
  const auto kernel2 = square(static_cast<float>(config_.kernel_sigma));
  float cost = 0.0F;
  int on_map = 0, fitting = 0;
  for (size_t i = 0; i < points_.size(); ++i) {
    const float x = square(plane_residual(i, plane)) * points_[i].weight;
    cost += std::isnan(x) ? points_[i].off_map_cost : x / (kernel2 + x);
    on_map += std::isnan(x) ? 0 : 1;
    fitting += x < kernel2 ? 1 : 0;
  }
  const double height = plane.x() / config_.height_sigma_m, tilt = plane.tail<2>().norm() / config_.tilt_sigma_rad;
  const double log_likelihood =
      -0.5 * (config_.temper * static_cast<double>(kernel2 * cost) + height * height + tilt * tilt);
  return {log_likelihood, on_map > 0 ? static_cast<double>(fitting) / on_map : 0.0, plane};
}

MatchFit ScanMatcher::fit(const Pose2& pose, int iterations) const {
  compute_residuals(pose);
  Eigen::Vector3f plane = start_plane_;
  for (int i = 0; i < iterations; ++i) plane = refit_plane(plane);
  return evaluate(plane);
}

// By finite differences over several centimetres: height noise averages out over this step and is not mistaken for
// information.
void ScanMatcher::differentiate(const Pose2& pose, Eigen::Vector3d& gradient, Eigen::Matrix3d& hessian) const {
  const Eigen::Vector3d step(config_.hessian_step_m, config_.hessian_step_m,
                             config_.hessian_step_m / config_.yaw_lever_m);
  const auto at = [&](const Eigen::Vector3d& offset) {
    return fit({pose.x_m + offset.x(), pose.y_m + offset.y(), pose.yaw_rad + offset.z()}).log_likelihood;
  };
  const double center = at(Eigen::Vector3d::Zero());
  Eigen::Matrix3d H;  // in units of `step`, as the gradient is
  const auto second_difference = [&](const Eigen::Vector3d& direction) {
    const Eigen::Vector3d offset = step.cwiseProduct(direction);
    return 2.0 * center - at(offset) - at(-offset);
  };
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d offset = step.cwiseProduct(Eigen::Vector3d::Unit(i));
    const double ahead = at(offset), behind = at(-offset);
    gradient(i) = 0.5 * (behind - ahead);
    H(i, i) = 2.0 * center - ahead - behind;
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < i; ++j) {
      const double both = second_difference((Eigen::Vector3d::Unit(i) + Eigen::Vector3d::Unit(j)) * std::sqrt(0.5));
      H(i, j) = H(j, i) = both - 0.5 * (H(i, i) + H(j, j));
    }
  const Eigen::Vector3d per_step = step.cwiseInverse();
  gradient = gradient.cwiseProduct(per_step).eval();
  hessian = per_step.asDiagonal() * H * per_step.asDiagonal();
}

MatchInformation ScanMatcher::information(const Pose2& pose) const {
  MatchInformation info;
  if (!has_enough_points()) return info;
  Eigen::Vector3d gradient;
  differentiate(pose, gradient, info.matrix);
  const Eigen::DiagonalMatrix<double, 3> scale(1.0, 1.0, config_.yaw_lever_m),
      unscale(1.0, 1.0, 1.0 / config_.yaw_lever_m);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(unscale * info.matrix * unscale);
  Eigen::Matrix3d projector = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const double eigenvalue = eigen.eigenvalues()(i);
    if (eigenvalue * config_.unobservable_sigma_m * config_.unobservable_sigma_m < 1.0) continue;
    if (info.observable_directions == 0) info.weakest_information = std::sqrt(eigenvalue);  // ascending order
    projector += eigen.eigenvectors().col(i) * eigen.eigenvectors().col(i).transpose();
    ++info.observable_directions;
  }
  info.observable = unscale * projector * scale;
  info.to_best = -info.observable * info.matrix.ldlt().solve(gradient);
  return info;
}

}  // namespace rover::slam
