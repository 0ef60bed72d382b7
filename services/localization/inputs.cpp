#include "localization/inputs.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace rover::loc {
namespace {

// Generous physical limits of this class of vehicle.
constexpr double kMaxRateRadps = 5.0;
constexpr double kMaxForceMps2 = 50.0;
constexpr double kMaxIntervalS = 0.2;
constexpr double kMaxPositionM = 1e6;

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
  if (!s.position_map_m.allFinite() || !std::isfinite(s.yaw_rad)) return "start pose not finite";
  if (s.position_map_m.cwiseAbs().maxCoeff() > kMaxPositionM) return "start position out of range";
  if (!(s.sigma_m > 0.0 && s.sigma_m < 1000.0)) return "sigma_m out of range";
  if (!(s.sigma_yaw_rad > 0.0 && s.sigma_yaw_rad <= kPi)) return "sigma_yaw_rad out of range";
  return {};
}

std::string_view validation_error(const MapMeasurement& m) {
  const Pose2& T = m.T_map_odom;
  if (!std::isfinite(T.x_m) || !std::isfinite(T.y_m) || !std::isfinite(T.yaw_rad)) return "pose not finite";
  if (std::max(std::abs(T.x_m), std::abs(T.y_m)) > kMaxPositionM) return "position out of range";
  if (!is_covariance(m.cov)) return "no covariance";
  return {};
}

}  // namespace rover::loc
