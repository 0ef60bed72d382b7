// Frames and rigid motions.
//
//   map    the orbital map's frame: x east, y north, z up; origin at the map's lower left corner
//   odom   starts at the ground's start pose, drifts, never jumps; obstacles and local paths live here
//   body   x forward, y left, z up; origin between the middle wheels, at the height given by config/vehicle.yaml
//   cam    z forward, x right, y down; of the left, rectified camera unless named otherwise
//
// T_a_b takes coordinates in b into coordinates in a; p_a_b is the position of b seen in a. (REP-103, REP-105.)
#pragma once

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <limits>
#include <numbers>

namespace rover {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPi = std::numbers::pi;

constexpr double to_rad(double deg) {
  return deg * kPi / 180.0;
}
constexpr double to_deg(double rad) {
  return rad * 180.0 / kPi;
}

// Into (-pi, pi].
double wrap_angle(double angle_rad);

// Planar pose: position and heading about z.
struct Pose2 {
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;
};

// Roll, pitch, yaw of R = Rz(yaw) Ry(pitch) Rx(roll). Pitch is positive nose down in body axes (y left).
Eigen::Vector3d rpy_of(const Eigen::Matrix3d& R);
Eigen::Matrix3d rotation_from_rpy(double roll_rad, double pitch_rad, double yaw_rad);
double yaw_of(const Eigen::Isometry3d& T);
Pose2 planar(const Eigen::Isometry3d& T);
Eigen::Isometry3d from_planar(const Pose2& pose);
// Pose of the point on the ground below the body origin, axes of the body. Paths, footprints and zones refer to it: on
// a slope of 15 deg the origin, 0.62 m above, lies 0.16 m downhill of it.
Eigen::Isometry3d ground_pose(const Eigen::Isometry3d& T_odom_body, double origin_height_m);

// Rotation vector (axis times angle) and back.
Eigen::Matrix3d exp_so3(const Eigen::Vector3d& rotation_rad);
Eigen::Vector3d log_so3(const Eigen::Matrix3d& R);
Eigen::Matrix3d skew(const Eigen::Vector3d& v);

Eigen::Isometry3d make_pose(const Eigen::Matrix3d& R, const Eigen::Vector3d& p);
Eigen::Isometry3d nan_pose();
Matrix6d nan_cov();
bool is_finite(const Eigen::Isometry3d& T);

// Position linear, rotation by slerp; u in [0, 1].
Eigen::Isometry3d interpolate(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double u);

// Camera axes (z forward, x right, y down) in body axes, for a camera that looks forward, pitched down by the angle.
Eigen::Matrix3d camera_rotation(double pitch_down_rad, double roll_rad = 0.0, double yaw_rad = 0.0);

}  // namespace rover
