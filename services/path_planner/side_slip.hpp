// How far the rover slides sideways on a slope: a vector in odom, in metres for each metre that the wheels roll. It
// points downhill; of it, the part across the heading moves the rover.
#pragma once

#include <algorithm>
#include <cmath>

#include "path_planner/geometry.hpp"

namespace rover::planning {

struct SideSlip {
  static constexpr double kLearningM = 1.0;  // driven until a change is known by 63 %
  static constexpr double kMinSpeedMps = 0.03;
  static constexpr double kMax = 0.36;  // 20 deg

  Point2 downhill;

  // To the left, for each metre driven, in either direction.
  double at(double yaw_rad) const { return std::cos(yaw_rad) * downhill.y_m - std::sin(yaw_rad) * downhill.x_m; }
  // Velocity of the body, over dt_s.
  void learn(double yaw_rad, double forward_mps, double left_mps, double dt_s) {
    const double speed_mps = std::abs(forward_mps);
    if (speed_mps < kMinSpeedMps) return;
    const double error = std::clamp(left_mps / speed_mps, -kMax, kMax) - at(yaw_rad);
    const double change = error * std::min(1.0, speed_mps * dt_s / kLearningM);
    downhill = {downhill.x_m - std::sin(yaw_rad) * change, downhill.y_m + std::cos(yaw_rad) * change};
  }
  // Where the rover is after an arc; `distance_m` is negative in reverse.
  Pose2 advanced(const Pose2& pose, double distance_m, double curvature_per_m) const {
    const Pose2 end = planning::advanced(pose, distance_m, curvature_per_m);
    const double slide_m = at(pose.yaw_rad) * std::abs(distance_m);
    return {end.x_m - std::sin(pose.yaw_rad) * slide_m, end.y_m + std::cos(pose.yaw_rad) * slide_m, end.yaw_rad};
  }
  // Heading of the body on a path whose tangent (of its front, also in reverse) is `path_yaw_rad`.
  double heading(double path_yaw_rad, bool reverse) const {
    const double slip_rad = std::atan(at(path_yaw_rad));
    return path_yaw_rad + (reverse ? slip_rad : -slip_rad);
  }
};

}  // namespace rover::planning
