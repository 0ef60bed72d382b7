#include "localization/inputs.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "common/core/start_pose.hpp"

namespace rover::loc {
namespace {

// Generous physical limits of this class of vehicle.
constexpr double kMaxRateRadps = 5.0;
constexpr double kMaxForceMps2 = 50.0;
constexpr double kMaxIntervalS = 0.2;

template <size_t N>
bool finite(const std::array<double, N>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

template <class Matrix>
bool is_covariance(const Matrix& cov) {
  if (!cov.allFinite() || !cov.isApprox(cov.transpose(), 1e-6)) return false;
  const auto values = Eigen::SelfAdjointEigenSolver<Matrix>(cov, Eigen::EigenvaluesOnly).eigenvalues();
  return values.minCoeff() >= -1e-12 && values.maxCoeff() > 0.0;
}

}  // namespace

std::string_view validation_error(const ImuSample& s) {
  if (!s.delta_angle_rad.allFinite() || !s.delta_velocity_mps.allFinite()) return "not finite";
  if (!(s.dt_s > 0.0 && s.dt_s <= kMaxIntervalS)) return "interval out of range";
  if (s.delta_angle_rad.norm() > kMaxRateRadps * s.dt_s) return "rate out of range";
  if (std::isfinite(s.fog_delta_yaw_rad) && std::abs(s.fog_delta_yaw_rad) > kMaxRateRadps * s.dt_s)
    return "fibre-optic gyro out of range";
  if (s.delta_velocity_mps.norm() > kMaxForceMps2 * s.dt_s) return "specific force out of range";
  return {};
}

std::string_view validation_error(const WheelSample& s) {
  if (!finite(s.drive_angle_rad) || !finite(s.drive_rate_radps) || !finite(s.steer_angle_rad)) return "not finite";
  for (double rate : s.drive_rate_radps)
    if (std::abs(rate) > kMaxWheelRateRadps) return "wheel rate out of range";
  for (double angle : s.steer_angle_rad)
    if (std::abs(angle) > kPi) return "steering angle out of range";
  return {};
}

std::string_view validation_error(const WheelCommand& c) {
  if (!finite(c.drive_rate_radps)) return "not finite";
  for (double rate : c.drive_rate_radps)
    if (std::abs(rate) > kMaxWheelRateRadps) return "wheel rate out of range";
  return {};
}

std::string_view validation_error(const VisualMotion& m, double max_speed_mps) {
  if (m.utime < 0 || m.previous_utime > m.utime) return "times contradict each other";
  if (m.status == VisualStatus::kLost) return {};
  if (m.previous_utime == m.utime || m.keyframe_utime > m.previous_utime) return "times contradict each other";
  if (!is_finite(m.T_prev_cur)) return "motion not finite";
  if (!is_covariance(m.cov)) return "no covariance";
  if (m.T_prev_cur.translation().norm() > max_speed_mps * to_seconds(m.utime - m.previous_utime))
    return "motion out of range";
  return {};
}

std::string_view validation_error(const StartPose& s) {
  return start_pose_problem(s.position_map_m, s.yaw_rad, s.sigma_m, s.sigma_yaw_rad);
}

std::string_view validation_error(const MapMeasurement& m) {
  const Pose2& T = m.T_map_odom;
  if (!std::isfinite(T.x_m) || !std::isfinite(T.y_m) || !std::isfinite(T.yaw_rad)) return "pose not finite";
  if (std::max(std::abs(T.x_m), std::abs(T.y_m)) > kMaxMapPositionM) return "position out of range";
  if (!is_covariance(m.cov)) return "no covariance";
  return {};
}

}  // namespace rover::loc
