#include "common/core/frames.hpp"

#include <algorithm>
#include <cmath>

namespace rover {

double wrap_angle(double angle_rad) {
  const double wrapped = std::remainder(angle_rad, 2.0 * kPi);
  return wrapped <= -kPi ? wrapped + 2.0 * kPi : wrapped;
}

Eigen::Vector3d rpy_of(const Eigen::Matrix3d& R) {
  return {std::atan2(R(2, 1), R(2, 2)), std::asin(std::clamp(-R(2, 0), -1.0, 1.0)), std::atan2(R(1, 0), R(0, 0))};
}

Eigen::Matrix3d rotation_from_rpy(double roll_rad, double pitch_rad, double yaw_rad) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return (AngleAxisd(yaw_rad, Vector3d::UnitZ()) * AngleAxisd(pitch_rad, Vector3d::UnitY()) *
          AngleAxisd(roll_rad, Vector3d::UnitX()))
      .toRotationMatrix();
}

double yaw_of(const Eigen::Isometry3d& T) {
  return std::atan2(T.linear()(1, 0), T.linear()(0, 0));
}

Pose2 planar(const Eigen::Isometry3d& T) {
  return {T.translation().x(), T.translation().y(), yaw_of(T)};
}

Eigen::Isometry3d ground_pose(const Eigen::Isometry3d& T_odom_body, double origin_height_m) {
  return T_odom_body * Eigen::Translation3d(0.0, 0.0, -origin_height_m);
}

Eigen::Isometry3d from_planar(const Pose2& pose) {
  return make_pose(rotation_from_rpy(0.0, 0.0, pose.yaw_rad), {pose.x_m, pose.y_m, 0.0});
}

Eigen::Matrix3d exp_so3(const Eigen::Vector3d& rotation_rad) {
  const double angle = rotation_rad.norm();
  if (angle < 1e-12) return Eigen::Matrix3d::Identity() + skew(rotation_rad);
  return Eigen::AngleAxisd(angle, rotation_rad / angle).toRotationMatrix();
}

Eigen::Vector3d log_so3(const Eigen::Matrix3d& R) {
  const Eigen::AngleAxisd rotation(R);
  return rotation.angle() * rotation.axis();
}

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d S;
  S << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return S;
}

Eigen::Isometry3d make_pose(const Eigen::Matrix3d& R, const Eigen::Vector3d& p) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = R;
  T.translation() = p;
  return T;
}

Eigen::Isometry3d nan_pose() {
  return make_pose(Eigen::Matrix3d::Constant(kNaN), Eigen::Vector3d::Constant(kNaN));
}

Matrix6d nan_cov() {
  return Matrix6d::Constant(kNaN);
}

bool is_finite(const Eigen::Isometry3d& T) {
  return T.matrix().allFinite();
}

Eigen::Isometry3d interpolate(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double u) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(a.linear()).slerp(u, Eigen::Quaterniond(b.linear()));
  return make_pose(q.toRotationMatrix(), (1.0 - u) * a.translation() + u * b.translation());
}

Eigen::Matrix3d camera_rotation(double pitch_down_rad, double roll_rad, double yaw_rad) {
  Eigen::Matrix3d R_level_cam;
  R_level_cam << 0, 0, 1,  //
      -1, 0, 0,            //
      0, -1, 0;
  return rotation_from_rpy(roll_rad, pitch_down_rad, yaw_rad) * R_level_cam;
}

}  // namespace rover
