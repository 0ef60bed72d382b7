#include "tools/one_process/motion_errors.hpp"

#include <cmath>

#include "common/core/frames.hpp"

namespace rover {
namespace {

constexpr double kScaleSigma = 0.0011;
constexpr double kKeyframeM = 0.45;  // distance and angle after which the keyframe changes
constexpr double kKeyframeRad = 0.2;
// Standard deviations of a registration: constant, and growth with the distance from the keyframe; x y z, roll pitch
// yaw. The published covariance is that of visual odometry's own estimate.
const Eigen::Vector3d kPositionM(0.5e-4, 0.6e-4, 1.0e-4);
const Eigen::Vector3d kPositionPerM(8.0e-4, 3.0e-4, 3.0e-4);
const Eigen::Vector3d kRotationRad(0.5e-4, 0.4e-4, 0.5e-4);
const Eigen::Vector3d kRotationRadPerM(2.0e-4, 4.0e-4, 1.5e-4);
const Eigen::Vector3d kStatedPositionM(0.65e-4, 1.0e-4, 1.4e-4);
const Eigen::Vector3d kStatedRotationRad(1.0e-4, 0.7e-4, 0.45e-4);
constexpr double kStatedPerM = 2.5e-4;
constexpr int kFeatures = 300;

Matrix6d stated_covariance(double distance_m) {
  Matrix6d covariance = Matrix6d::Zero();
  for (int i = 0; i < 3; ++i) {
    covariance(i, i) = std::pow(kStatedPositionM[i] + kStatedPerM * distance_m, 2);
    covariance(i + 3, i + 3) = std::pow(kStatedRotationRad[i] + kStatedPerM * distance_m, 2);
  }
  return covariance;
}

}  // namespace

MotionErrors::MotionErrors(std::uint64_t seed) : random_(seed) {
  scale_ = 1.0 + kScaleSigma * std::normal_distribution<double>()(random_);
}

std::optional<vo::OdometryResult> MotionErrors::step(Utime utime, const Eigen::Isometry3d& T_map_body) {
  if (previous_utime_ == kNever) {
    keyframe_utime_ = previous_utime_ = utime;
    T_map_key_ = T_map_previous_ = T_map_body;
    T_key_previous_ = Eigen::Isometry3d::Identity();
    return std::nullopt;
  }
  const Eigen::Isometry3d T_key_previous = T_map_key_.inverse() * T_map_previous_;
  if (T_key_previous.translation().norm() > kKeyframeM || log_so3(T_key_previous.linear()).norm() > kKeyframeRad) {
    keyframe_utime_ = previous_utime_;
    T_map_key_ = T_map_previous_;
    T_key_previous_ = Eigen::Isometry3d::Identity();
  }
  const Eigen::Isometry3d T_key_body = T_map_key_.inverse() * T_map_body;
  const Eigen::Isometry3d T_key_registered = registered(T_key_body);
  vo::OdometryResult result;
  result.status = vo::Status::kOk;
  result.previous_utime = previous_utime_;
  result.utime = utime;
  result.keyframe_utime = keyframe_utime_;
  result.T_prev_cur = T_key_previous_.inverse() * T_key_registered;
  result.cov = stated_covariance(T_key_body.translation().norm());
  result.features = result.inliers = kFeatures;
  result.rms_px = 0.2;
  previous_utime_ = utime;
  T_map_previous_ = T_map_body;
  T_key_previous_ = T_key_registered;
  return result;
}

Eigen::Isometry3d MotionErrors::registered(const Eigen::Isometry3d& T_key_body) {
  const double distance_m = T_key_body.translation().norm();
  const Eigen::Vector3d turned = noise(kRotationRad + distance_m * kRotationRadPerM);
  const Eigen::Vector3d moved = noise(kPositionM + distance_m * kPositionPerM);
  return make_pose(T_key_body.linear() * exp_so3(turned), scale_ * T_key_body.translation() + moved);
}

Eigen::Vector3d MotionErrors::noise(const Eigen::Vector3d& sigma) {
  std::normal_distribution<double> normal;
  return {sigma.x() * normal(random_), sigma.y() * normal(random_), sigma.z() * normal(random_)};
}

}  // namespace rover
