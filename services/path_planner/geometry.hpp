// Plane geometry of a rectangular vehicle on circular arcs.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "common/core/frames.hpp"

namespace rover::planning {

struct Point2 {
  double x_m = 0.0;
  double y_m = 0.0;
};

inline double distance(Point2 a, Point2 b) {
  const double dx = a.x_m - b.x_m;
  const double dy = a.y_m - b.y_m;
  return std::sqrt(dx * dx + dy * dy);
}
inline Point2 position(const Pose2& pose) {
  return {pose.x_m, pose.y_m};
}

inline Point2 to_body(const Pose2& pose, Point2 p) {
  const double c = std::cos(pose.yaw_rad);
  const double s = std::sin(pose.yaw_rad);
  const double dx = p.x_m - pose.x_m;
  const double dy = p.y_m - pose.y_m;
  return {c * dx + s * dy, c * dy - s * dx};
}
inline Point2 from_body(const Pose2& pose, Point2 p) {
  const double c = std::cos(pose.yaw_rad);
  const double s = std::sin(pose.yaw_rad);
  return {pose.x_m + c * p.x_m - s * p.y_m, pose.y_m + s * p.x_m + c * p.y_m};
}
inline Pose2 inverse(const Pose2& T) {
  const Point2 p = to_body(T, {});
  return {p.x_m, p.y_m, -T.yaw_rad};
}

// Along an arc of the signed curvature (positive: left).
inline Pose2 advanced(const Pose2& pose, double distance_m, double curvature_per_m) {
  const double turned = distance_m * curvature_per_m;
  const double chord = std::abs(turned) < 1e-9 ? distance_m : 2.0 * std::sin(0.5 * turned) / curvature_per_m;
  const double middle = pose.yaw_rad + 0.5 * turned;
  return {pose.x_m + chord * std::cos(middle), pose.y_m + chord * std::sin(middle), pose.yaw_rad + turned};
}

// Which of `bins` equal parts of the circle the heading lies in.
inline int heading_bin(double yaw_rad, int bins) {
  const double turn = yaw_rad / (2.0 * kPi);
  return std::clamp(static_cast<int>((turn - std::floor(turn)) * bins), 0, bins - 1);
}

// The ground that wheels and body cover, about the body origin.
struct Footprint {
  double half_length_m = 0.0;
  double half_width_m = 0.0;
  double half_gap_m = 0.0;         // between the wheels of both sides, where the body passes over low obstacles
  std::array<Point2, 6> wheels{};  // their axles, seen from above

  double radius_m() const { return std::hypot(half_length_m, half_width_m); }

  // From the edge to the point, negative inside.
  double distance_m(Point2 in_body) const {
    const double dx = std::abs(in_body.x_m) - half_length_m;
    const double dy = std::abs(in_body.y_m) - half_width_m;
    if (dx > 0.0 && dy > 0.0) return std::sqrt(dx * dx + dy * dy);
    return std::max(dx, dy);
  }
  double distance_m(const Pose2& pose, Point2 p) const { return distance_m(to_body(pose, p)); }
  // The same, of the two strips that the wheels cover.
  double wheel_distance_m(Point2 in_body) const {
    const double middle = 0.5 * (half_gap_m + half_width_m);
    return Footprint{half_length_m, half_width_m - middle}.distance_m({in_body.x_m, std::abs(in_body.y_m) - middle});
  }
  double wheel_distance_m(const Pose2& pose, Point2 p) const { return wheel_distance_m(to_body(pose, p)); }
  bool wheel_is_on(const Pose2& pose, Point2 p) const {
    const Point2 in_body = to_body(pose, p);
    return std::any_of(wheels.begin(), wheels.end(),
                       [&](Point2 wheel) { return distance(wheel, in_body) <= 0.5 * (half_width_m - half_gap_m); });
  }
  // To a hazard; the body passes over a low one.
  double hazard_distance_m(const Pose2& pose, Point2 p, bool low) const {
    return low ? wheel_distance_m(pose, p) : distance_m(pose, p);
  }
};

}  // namespace rover::planning
