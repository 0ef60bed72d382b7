#include "localization/wheel_odometry.hpp"

#include <Eigen/QR>
#include <cmath>

namespace rover::loc {
namespace {

std::array<double, 6> all_angles(const std::array<double, 4>& steer_rad) {
  std::array<double, 6> angles{};
  for (size_t i = 0; i < steer_rad.size(); ++i) angles[static_cast<size_t>(kSteeredWheels[i])] = steer_rad[i];
  return angles;
}

// Rolling distance of the wheel per (dx, dy, dyaw).
Eigen::RowVector3d rolling_row(double x, double y, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {c, s, x * s - y * c};
}

// Lateral displacement of the wheel per (dx, dy, dyaw).
Eigen::RowVector3d lateral_row(double x, double y, double angle) {
  return rolling_row(x, y, angle + 0.5 * M_PI);
}

}  // namespace

Eigen::Vector3d WheelOdometry::body_motion(const std::array<double, 6>& wheel_turn_rad,
                                           const std::array<double, 4>& steer_rad) const {
  const std::array<double, 6> angles = all_angles(steer_rad);
  Eigen::Matrix<double, 12, 3> A;
  Eigen::Matrix<double, 12, 1> b;
  for (size_t i = 0; i < 6; ++i) {
    const auto row = static_cast<Eigen::Index>(2 * i);
    A.row(row) = rolling_row(vehicle_.wheel_x_m[i], vehicle_.wheel_y_m[i], angles[i]);
    A.row(row + 1) = lateral_row(vehicle_.wheel_x_m[i], vehicle_.wheel_y_m[i], angles[i]);
    b(row) = vehicle_.wheel_radius_m * wheel_turn_rad[i];
    b(row + 1) = 0.0;
  }
  return A.colPivHouseholderQr().solve(b);
}

std::array<double, 6> WheelOdometry::wheel_travel_m(const Eigen::Vector3d& motion,
                                                    const std::array<double, 4>& steer_rad) const {
  const std::array<double, 6> angles = all_angles(steer_rad);
  std::array<double, 6> rolled{};
  for (size_t i = 0; i < 6; ++i)
    rolled[i] = rolling_row(vehicle_.wheel_x_m[i], vehicle_.wheel_y_m[i], angles[i]) * motion;
  return rolled;
}

double WheelOdometry::path_m(const std::array<double, 6>& wheel_turn_rad) const {
  double sum = 0.0;
  for (double turned : wheel_turn_rad) sum += std::abs(vehicle_.wheel_radius_m * turned);
  return sum / 6.0;
}

}  // namespace rover::loc
