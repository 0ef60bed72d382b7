#include "localization/map_alignment.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace rover::loc {
namespace {

// Indices of x, y, yaw in the filter's error state.
constexpr std::array<int, 3> kPlanar = {kPosition, kPosition + 1, kAttitude + 2};

using PlanarRows = Eigen::Matrix<double, 3, kErrorSize>;

PlanarRows planar_rows() {
  PlanarRows H = PlanarRows::Zero();
  for (int i = 0; i < 3; ++i) H(i, kPlanar[static_cast<size_t>(i)]) = 1.0;
  return H;
}

// Map and odom differ by a rotation about z.
Eigen::Matrix3d planar_rotation(const Eigen::Isometry3d& T) {
  return rotation_from_rpy(0.0, 0.0, yaw_of(T));
}

}  // namespace

void MapAlignment::set_start(const StartPose& start, const Eigen::Isometry3d& T_odom_body) {
  const double yaw = wrap_angle(start.yaw_rad - yaw_of(T_odom_body));
  const Eigen::Matrix3d R = rotation_from_rpy(0.0, 0.0, yaw);
  restore(make_pose(R, start.position_map_m - R * T_odom_body.translation()));
}

void MapAlignment::restore(const Eigen::Isometry3d& T_map_odom) {
  T_map_odom_ = T_map_odom;
  slam_.reset();
  pending_.setZero();
  known_ = true;
}

Eigen::Vector3d MapAlignment::innovation(const MapMeasurement& m, const Eigen::Isometry3d& T_odom_body) const {
  const Eigen::Isometry3d measured = from_planar(m.T_map_odom) * T_odom_body;
  const Eigen::Isometry3d estimated = T_map_odom_ * T_odom_body;
  const Eigen::Vector3d residual = measured.translation() - estimated.translation();
  return {residual.x(), residual.y(), wrap_angle(m.T_map_odom.yaw_rad - yaw_of(T_map_odom_))};
}

Eigen::Matrix3d MapAlignment::planar_cov(const ErrorCov& P) const {
  const PlanarRows H = planar_rows();
  const Eigen::Matrix3d R = planar_rotation(T_map_odom_);
  return R * (H * P * H.transpose()) * R.transpose();
}

Eigen::Vector3d MapAlignment::correction(const Eigen::Vector3d& innovation, const ErrorCov& P,
                                         const PlanarCov& R) const {
  const Eigen::Matrix3d C = planar_cov(P);
  return C * (C + R).inverse() * innovation;
}

ErrorCov MapAlignment::updated_cov(const ErrorCov& P, const PlanarCov& R_map) const {
  const Eigen::Matrix3d rotation = planar_rotation(T_map_odom_);
  const PlanarCov R = rotation.transpose() * R_map * rotation;
  const PlanarRows H = planar_rows();
  const Eigen::Matrix3d C = H * P * H.transpose();
  const Eigen::Matrix<double, kErrorSize, 3> K = H.transpose() * (C * (C + R).inverse());
  const ErrorCov I_KH = ErrorCov::Identity() - K * H;
  return I_KH * P * I_KH.transpose() + K * R * K.transpose();
}

void MapAlignment::shift(const Eigen::Vector3d& delta, const Eigen::Isometry3d& T_odom_body) {
  const Eigen::Vector3d p = T_map_odom_ * T_odom_body.translation();
  const Eigen::Vector3d moved = p + Eigen::Vector3d(delta.x(), delta.y(), 0.0);
  const Eigen::Matrix3d R = rotation_from_rpy(0.0, 0.0, yaw_of(T_map_odom_) + delta.z());
  T_map_odom_ = make_pose(R, moved - R * T_odom_body.translation());
}

bool MapAlignment::within_gate(const MapMeasurement& m, const Eigen::Isometry3d& T_odom_body, const ErrorCov& P) const {
  const Eigen::Vector3d residual = innovation(m, T_odom_body);
  const Eigen::Matrix3d S = planar_cov(P) + m.cov;
  return residual.dot(S.inverse() * residual) <= config_.gate_chi2;
}

ErrorCov MapAlignment::inflated(ErrorCov P, const PlanarCov& R_map) const {
  const Eigen::DiagonalMatrix<double, 3> sigma(config_.inflation_m, config_.inflation_m, config_.inflation_rad);
  const Eigen::Matrix3d rotation = planar_rotation(T_map_odom_);
  const Eigen::Matrix3d R = sigma.inverse() * (rotation.transpose() * R_map * rotation) * sigma.inverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(R);
  const PlanarRows H = planar_rows();
  for (int i = 0; i < 3; ++i) {
    if (axes.eigenvalues()(i) > 1.0) continue;
    const Eigen::Vector3d along = sigma * axes.eigenvectors().col(i);
    P += H.transpose() * (along * along.transpose()) * H;
  }
  return P;
}

std::string_view MapAlignment::rejection(const MapMeasurement& m, const Eigen::Isometry3d& T_odom_body,
                                         const ErrorCov& P) const {
  if (!known_) return "no start pose yet";
  if (m.utime <= newest_correction_utime_) return "older than a correction already taken";
  if (!within_gate(m, T_odom_body, P)) return "further off than its covariance and ours allow";
  return {};
}

std::string_view MapAlignment::apply_correction(const MapMeasurement& m, const Eigen::Isometry3d& T_odom_body,
                                                const ErrorCov& P) {
  if (const auto reason = rejection(m, T_odom_body, P); !reason.empty()) return reason;
  newest_correction_utime_ = m.utime;
  slam_.reset();
  pending_.setZero();
  shift(correction(innovation(m, T_odom_body), P, m.cov), T_odom_body);
  return {};
}

bool MapAlignment::add_slam_pose(const MapMeasurement& m, const FilterState& odometry) {
  const auto before = std::exchange(slam_, SlamPose{m, odometry.noise_m2, odometry.noise_rad2});
  // SLAM's yaw variance grows from its anchor on. If it shrinks, the anchor is new, and the step is no motion.
  if (!before || m.cov(2, 2) < before->measurement.cov(2, 2)) return false;
  const auto weight = [](double noise, double noise_before, double sigma) {
    const double gained = std::max(0.0, noise - noise_before);
    return gained / (gained + sigma * sigma);
  };
  const double position = weight(odometry.noise_m2, before->noise_m2, config_.slam_sigma_m);
  const double yaw = weight(odometry.noise_rad2, before->noise_rad2, config_.slam_sigma_rad);
  const Eigen::Vector3d moved = (from_planar(m.T_map_odom) * odometry.T_odom_body).translation() -
                                (from_planar(before->measurement.T_map_odom) * odometry.T_odom_body).translation();
  pending_ += Eigen::Vector3d(position * moved.x(), position * moved.y(),
                              yaw * wrap_angle(m.T_map_odom.yaw_rad - before->measurement.T_map_odom.yaw_rad));
  return true;
}

void MapAlignment::step(double dt_s, const Eigen::Isometry3d& T_odom_body) {
  const double distance_m = pending_.head<2>().norm();
  const double share_m = distance_m > 0.0 ? std::min(1.0, config_.slam_rate_mps * dt_s / distance_m) : 1.0;
  const double angle_rad = std::abs(pending_.z());
  const double share_rad = angle_rad > 0.0 ? std::min(1.0, config_.slam_rate_radps * dt_s / angle_rad) : 1.0;
  const Eigen::Vector3d part(share_m * pending_.x(), share_m * pending_.y(), share_rad * pending_.z());
  if (part.isZero(0.0)) return;
  shift(part, T_odom_body);
  pending_ -= part;
}

}  // namespace rover::loc
