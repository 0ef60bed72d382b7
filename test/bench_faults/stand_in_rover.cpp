#include "test/bench_faults/stand_in_rover.hpp"

#include <algorithm>
#include <cmath>

#include "common/bus/convert.hpp"
#include "test/path_planner/randoms.hpp"

namespace rover::bench_faults {
namespace {

constexpr double kTickS = to_seconds(kTickUs);
constexpr double kGravityMps2 = 3.71;
constexpr double kGyroNoiseRad = 6.0e-6;  // per sample
constexpr double kForceNoiseMps = 2.0e-4;
constexpr double kShoveMps2 = 3.0;
constexpr double kRollingA = 1.2;
constexpr double kSteeringA = 0.2;

double towards(double from, double to, double most) {
  return from + std::clamp(to - from, -most, most);
}

}  // namespace

double StandInRover::noise(double sigma) {
  return sigma * planning::testing_support::gauss(random_);
}

WheelSetpoints StandInRover::obeyed() const {
  WheelSetpoints out;
  std::copy_n(command_.steer_angle_rad, 4, out.steer_angle_rad.begin());
  if (command_.valid_until_utime >= now_) std::copy_n(command_.drive_rate_radps, 6, out.drive_rate_radps.begin());
  if (broken.runaway_mps != 0.0) out.drive_rate_radps.fill(broken.runaway_mps / vehicle_.wheel_radius_m);
  if (broken.stands) out.drive_rate_radps.fill(0.0);
  return out;
}

void StandInRover::tilt(double dt_s) {
  const double most = broken.tilt_radps * dt_s;
  roll_rad_ = towards(roll_rad_, broken.roll_rad, most);
  pitch_rad_ = towards(pitch_rad_, broken.pitch_rad, most);
}

void StandInRover::step(Utime now) {
  now_ = now;
  T_before_ = T_map_body();
  velocity_before_mps_ = velocity_mps_;
  steer_before_rad_ = rover_.wheels().steer_angle_rad;
  rover_.slip_ratio = rover_.turn_slip = broken.slip_ratio;
  rover_.step(obeyed(), kTickS);
  Pose2 pose = rover_.pose();
  shove_mps_ = towards(shove_mps_, broken.shove_mps, kShoveMps2 * kTickS);
  pose.x_m -= std::sin(pose.yaw_rad) * shove_mps_ * kTickS;
  pose.y_m += std::cos(pose.yaw_rad) * shove_mps_ * kTickS;
  rover_.put(pose);
  tilt(kTickS);
  for (size_t i = 0; i < 6; ++i) drive_angle_rad_[i] += rover_.wheels().drive_rate_radps[i] * kTickS;
  velocity_mps_ = (T_map_body().translation() - T_before_.translation()) / kTickS;
}

Eigen::Isometry3d StandInRover::T_map_body() const {
  const Pose2& p = rover_.pose();
  return make_pose(rotation_from_rpy(roll_rad_, pitch_rad_, p.yaw_rad), {p.x_m, p.y_m, vehicle_.origin_height_m});
}

imu_t StandInRover::imu() {
  imu_t out{};
  out.dt_s = kTickS;
  const Eigen::Isometry3d T = T_map_body();
  const Eigen::Vector3d turned = log_so3(T_before_.linear().transpose() * T.linear());
  const Eigen::Vector3d felt = velocity_mps_ - velocity_before_mps_ + Eigen::Vector3d(0.0, 0.0, kGravityMps2 * kTickS);
  const Eigen::Vector3d force = T.linear().transpose() * felt;
  for (int i = 0; i < 3; ++i) {
    out.delta_angle_rad[i] = turned[i] + noise(kGyroNoiseRad);
    out.delta_velocity_mps[i] = force[i] + noise(kForceNoiseMps);
  }
  out.fog_delta_yaw_rad = turned.z();
  out.status = broken.imu_fault ? imu_t::FAULT : imu_t::OK;
  return out;
}

wheel_state_t StandInRover::wheels() const {
  wheel_state_t out{};
  const WheelSetpoints& wheels = rover_.wheels();
  for (size_t i = 0; i < 6; ++i) {
    const double rate = wheels.drive_rate_radps[i];
    out.drive_angle_rad[i] = drive_angle_rad_[i];
    out.drive_rate_radps[i] = rate;
    out.drive_current_a[i] = broken.drive_a[i] != 0.0 ? broken.drive_a[i] : std::abs(rate) > 0.01 ? kRollingA : 0.0;
  }
  for (size_t i = 0; i < 4; ++i) {
    const bool steers = std::abs(wheels.steer_angle_rad[i] - steer_before_rad_[i]) > 1e-4;
    out.steer_angle_rad[i] = wheels.steer_angle_rad[i];
    out.steer_current_a[i] = broken.steer_a[i] != 0.0 ? broken.steer_a[i] : steers ? kSteeringA : 0.0;
  }
  out.status = broken.wheel_fault                  ? wheel_state_t::FAULT
               : command_.valid_until_utime < now_ ? wheel_state_t::COMMAND_EXPIRED
                                                   : wheel_state_t::OK;
  return out;
}

truth_t StandInRover::truth() const {
  truth_t out{};
  pose_to(T_map_body(), out.position_map_body_m, out.quat_map_body_wxyz);
  std::copy_n(velocity_mps_.data(), 3, out.velocity_map_mps);
  return out;
}

}  // namespace rover::bench_faults
