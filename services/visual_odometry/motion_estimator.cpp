#include "visual_odometry/motion_estimator.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "visual_odometry/projection.hpp"

namespace rover::vo {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix36d = Eigen::Matrix<double, 3, 6>;

constexpr int kMinimalIterations = 6;
constexpr int kRefineIterations = 15;
constexpr double kConvergedStep = 1e-9;

// Left perturbation (translation, rotation).
Eigen::Isometry3d left_update(const Vector6d& step, const Eigen::Isometry3d& T) {
  const Eigen::Matrix3d R = exp_so3(step.tail<3>());
  return make_pose(R * T.linear(), R * T.translation() + step.head<3>());
}

Matrix36d jacobian(const StereoCamera& camera, const Eigen::Vector3d& p_cam) {
  const Eigen::Matrix3d H = project_jacobian(camera, p_cam);
  Matrix36d J;
  J << H, -H * skew(p_cam);
  return J;
}

double left_error_px(const Observation& o, const StereoCamera& camera, const Eigen::Isometry3d& T) {
  const Eigen::Vector3d p = T * o.p_key;
  if (p.z() < kMinDepthM) return kInfinity;
  return (project(camera, p) - o.z).head<2>().norm();
}

// Newton on three points: six equations, six unknowns. False if it does not converge.
bool solve_minimal(const std::array<const Observation*, 3>& points, const StereoCamera& camera, Eigen::Isometry3d& T) {
  for (int i = 0; i < kMinimalIterations; ++i) {
    Matrix6d J;
    Vector6d r;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d p = T * points[k]->p_key;
      if (p.z() < kMinDepthM) return false;
      J.middleRows<2>(2 * k) = jacobian(camera, p).topRows<2>();
      r.segment<2>(2 * k) = (points[k]->z - project(camera, p)).head<2>();
    }
    const Vector6d step = J.partialPivLu().solve(r);
    if (!step.allFinite() || step.norm() > 10.0) return false;
    T = left_update(step, T);
    if (step.norm() < 1e-7) return true;
  }
  return false;
}

int count_inliers(const std::vector<Observation>& observations, const StereoCamera& camera, const Eigen::Isometry3d& T,
                  double gate_px) {
  return static_cast<int>(std::count_if(observations.begin(), observations.end(),
                                        [&](const Observation& o) { return left_error_px(o, camera, T) < gate_px; }));
}

// Three different observations, without std::uniform_int_distribution, which differs between libraries.
std::array<const Observation*, 3> draw_three(const std::vector<Observation>& observations, std::mt19937_64& random) {
  std::array<size_t, 3> pick{};
  const size_t n = observations.size();
  pick[0] = random() % n;
  do pick[1] = random() % n;
  while (pick[1] == pick[0]);
  do pick[2] = random() % n;
  while (pick[2] == pick[0] || pick[2] == pick[1]);
  return {&observations[pick[0]], &observations[pick[1]], &observations[pick[2]]};
}

// RANSAC iterations for one all-inlier sample with the given confidence.
double required_iterations(double inlier_ratio, double confidence) {
  const double all_inliers = inlier_ratio * inlier_ratio * inlier_ratio;
  if (all_inliers >= 1.0) return 0.0;
  return std::log(1.0 - confidence) / std::log(1.0 - all_inliers);
}

// Linearised residual of one observation.
struct Linearised {
  Eigen::Vector3d r;
  Matrix36d J;
  Eigen::Matrix3d weight;    // inverse covariance of the residual
  Eigen::Vector3d J_offset;  // derivative of the prediction by the disparity offset
  double chi2;
  int size;
};

bool linearise(const Observation& o, const StereoCamera& camera, const Eigen::Isometry3d& T, const MotionConfig& config,
               Linearised& out) {
  const Eigen::Vector3d p = T * o.p_key;
  if (p.z() < kMinDepthM) return false;
  out.r = o.z - project(camera, p);
  out.J = jacobian(camera, p);
  // p_key = ray * f b / d, so disparity noise of the keyframe moves the point by -p_key / d.
  const Eigen::Vector3d ray = T.linear() * o.p_key / o.disparity_px * config.disparity_sigma_px;
  const Eigen::Vector3d a = project_jacobian(camera, p) * ray;
  const double variance = config.pixel_sigma_px * config.pixel_sigma_px;
  out.J_offset = -project_jacobian(camera, p) * (T.linear() * o.p_key / o.disparity_px) + Eigen::Vector3d::UnitZ();
  out.size = o.has_right ? 3 : 2;
  out.weight.setZero();
  if (o.has_right) {
    out.weight = (variance * Eigen::Matrix3d::Identity() + a * a.transpose()).inverse();
  } else {
    const Eigen::Vector2d b = a.head<2>();
    out.weight.topLeftCorner<2, 2>() = (variance * Eigen::Matrix2d::Identity() + b * b.transpose()).inverse();
    out.r.z() = 0.0;
    out.J.row(2).setZero();
    out.J_offset.z() = 0.0;
  }
  out.chi2 = out.r.dot(out.weight * out.r);
  return true;
}

// Cauchy weight.
double robust_weight(double chi2, double gate_sigma) {
  return 1.0 / (1.0 + chi2 / (gate_sigma * gate_sigma));
}

// Gradient and information of the disparity offset, with the motion (Hessian H) marginalised (Schur complement).
OffsetMeasurement measure_offset(const std::vector<Observation>& observations, const StereoCamera& camera,
                                 const Eigen::Isometry3d& T, const MotionConfig& config, const Matrix6d& H) {
  OffsetMeasurement measurement;
  Vector6d coupling = Vector6d::Zero();
  Linearised l;
  for (const Observation& o : observations) {
    if (!linearise(o, camera, T, config, l)) continue;
    const Eigen::Vector3d weighted = robust_weight(l.chi2, config.gate_sigma) * (l.weight * l.J_offset);
    measurement.gradient += weighted.dot(l.r);
    measurement.information += weighted.dot(l.J_offset);
    coupling.noalias() += l.J.transpose() * weighted;
  }
  measurement.information -= coupling.dot(H.ldlt().solve(coupling));
  return measurement;
}

}  // namespace

RansacResult ransac(const std::vector<Observation>& observations, const StereoCamera& camera,
                    const Eigen::Isometry3d& T_guess, const MotionConfig& config, std::uint64_t seed) {
  RansacResult best{T_guess, count_inliers(observations, camera, T_guess, config.coarse_gate_px)};
  if (observations.size() < 3) return best;
  std::mt19937_64 random(seed);
  const auto total = static_cast<double>(observations.size());
  double needed = config.ransac_iterations;
  for (int i = 0; i < config.ransac_iterations && i < needed; ++i) {
    RansacResult hypothesis{T_guess, 0};
    if (!solve_minimal(draw_three(observations, random), camera, hypothesis.T_cur_key)) continue;
    hypothesis.inliers = count_inliers(observations, camera, hypothesis.T_cur_key, config.coarse_gate_px);
    if (hypothesis.inliers <= best.inliers) continue;
    best = hypothesis;
    needed = required_iterations(best.inliers / total, config.confidence);
  }
  return best;
}

MotionEstimate refine(const std::vector<Observation>& observations, const StereoCamera& camera,
                      const Eigen::Isometry3d& T_start, const MotionConfig& config) {
  MotionEstimate estimate;
  Eigen::Isometry3d T = T_start;
  Matrix6d H = Matrix6d::Zero();
  Linearised l;
  for (int i = 0; i < kRefineIterations; ++i) {
    H.setZero();
    Vector6d g = Vector6d::Zero();
    for (const Observation& o : observations) {
      if (!linearise(o, camera, T, config, l)) continue;
      const double w = robust_weight(l.chi2, config.gate_sigma);
      H.noalias() += w * l.J.transpose() * l.weight * l.J;
      g.noalias() += w * l.J.transpose() * (l.weight * l.r);
    }
    const Vector6d step = H.ldlt().solve(g);
    if (!step.allFinite()) return estimate;
    T = left_update(step, T);
    if (step.squaredNorm() < kConvergedStep * kConvergedStep) break;
  }
  double chi2 = 0.0;
  double square_px = 0.0;
  int residual_count = 0;
  for (size_t i = 0; i < observations.size(); ++i) {
    if (!linearise(observations[i], camera, T, config, l)) continue;
    if (l.chi2 > config.gate_sigma * config.gate_sigma * l.size / 2.0) continue;
    ++estimate.inliers;
    chi2 += l.chi2;
    square_px += l.r.squaredNorm();
    residual_count += l.size;
  }
  if (residual_count <= 6) return estimate;
  estimate.T_cur_key = T;
  // Scaled by the observed residual variance if it exceeds the assumed noise.
  estimate.cov = Matrix6d(H.inverse()) * std::max(1.0, chi2 / (residual_count - 6));
  estimate.offset = measure_offset(observations, camera, T, config, H);
  estimate.rms_px = std::sqrt(square_px / residual_count);
  return estimate;
}

}  // namespace rover::vo
