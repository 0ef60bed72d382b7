// Synthetic drive over rolling ground: seeded noisy IMU, wheel and visual odometry from the exact motion.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <deque>
#include <functional>
#include <random>

#include "common/core/frames.hpp"
#include "localization/localization.hpp"

namespace rover::loc {

inline Vehicle test_vehicle() {
  Vehicle v;
  v.origin_height_m = 0.62;
  v.wheel_radius_m = 0.125;
  v.wheel_x_m = {0.75, 0.75, 0.0, 0.0, -0.75, -0.75};
  v.wheel_y_m = {0.41, -0.41, 0.41, -0.41, 0.41, -0.41};
  return v;
}

struct DriveNoise {
  double gyro = 4.4e-5;       // rad/sqrt(s)
  double gyro_bias = 2.4e-5;  // rad/s, rms
  double fog = 3.5e-6;
  double fog_bias = 4.8e-6;
  double force = 1.2e-3;   // m/s/sqrt(s)
  double visual_m = 5e-4;  // of one keyframe's alignment
  double visual_rad = 3e-4;
  double visual_scale = 0.0;  // rms
  double mounting_rad = 0.0;  // of the camera on the body, rms of each axis
  double encoder_rad = 1e-4;
};

// Commanded forward speed and yaw rate.
struct Twist {
  double speed_mps = 0.0;
  double rate_radps = 0.0;
};

// Static alignment of 1 s, with the gyro bias sigmas that it gives.
inline LocalizationConfig short_alignment(LocalizationConfig config) {
  config.static_alignment.duration_s = 1.0;
  config.filter.gyro_bias_sigma_radps = 8e-5;
  config.filter.fog_bias_sigma_radps = 1.5e-5;
  return config;
}

class SyntheticDrive {
 public:
  std::function<Twist(double)> command = [](double) { return Twist{}; };
  std::function<double(double)> slip = [](double) { return 0.0; };   // of all wheels
  std::function<double(double)> scrub = [](double) { return 0.0; };  // yaw rate while the wheels steer on the spot
  std::function<Eigen::Vector2d(double)> rock = [](double) { return Eigen::Vector2d(0, 0); };  // roll, pitch: on rocks
  bool rolling_ground = true;

  // Inputs of localization.
  bool imu_on = true;
  bool wheels_on = true;
  bool visual_on = true;
  bool visual_lost = false;      // every frame is lost
  bool process_stalled = false;  // localization does not step
  std::function<void(ImuSample&)> corrupt_imu = [](ImuSample&) {};
  std::function<void(VisualMotion&)> corrupt_visual = [](VisualMotion&) {};

  SyntheticDrive(const LocalizationConfig& config, std::uint64_t seed, const DriveNoise& noise = {})
      : localization(short_alignment(config), test_vehicle()), noise_(noise), wheels_(test_vehicle()), random_(seed) {
    gyro_bias_ = noise.gyro_bias * normal3();
    gyro_bias_z_fog_ = noise.fog_bias * normal_(random_);
    scale_ = noise.visual_scale * normal_(random_);
    if (noise.mounting_rad > 0.0) T_true_nominal_.linear() = exp_so3(noise.mounting_rad * normal3());
  }

  Localization localization;
  Utime now() const { return now_; }
  // The clock jumps between two ticks without motion.
  void step_clock(double seconds) { now_ += to_utime(seconds) / kTickUs * kTickUs; }
  const Eigen::Isometry3d& truth() const { return T_world_body_; }
  double driven_m() const { return driven_m_; }

  // Ground truth in odom, whose z is up and whose x is the initial heading.
  Eigen::Isometry3d truth_odom() const {
    const Eigen::Isometry3d T_world_odom = make_pose(rotation_from_rpy(0.0, 0.0, yaw_of(start_)), start_.translation());
    return T_world_odom.inverse() * T_world_body_;
  }

  // Static alignment at standstill for 1.5 s, then the start pose.
  void align_and_start(double sigma_m = 0.1, double sigma_yaw = 0.01) {
    run(1.5);
    localization.set_start_pose({Eigen::Vector3d(100.0, 50.0, 3.0), 0.5, sigma_m, sigma_yaw});
  }

  void run(
      double seconds, const std::function<void()>& each_tick = [] {}) {
    const Utime until = now_ + to_utime(seconds);
    while (now_ < until) {
      tick();
      each_tick();
    }
  }

 private:
  struct PendingMotion {
    Utime release;
    VisualMotion motion;
  };

  double normal() { return normal_(random_); }
  Eigen::Vector3d normal3() { return {normal(), normal(), normal()}; }

  Eigen::Isometry3d surface_pose(double x, double y, double yaw) const {
    const double h = rolling_ground ? 1.0 : 0.0;
    const double z = h * (0.3 * std::sin(0.35 * x) + 0.2 * std::cos(0.4 * y));
    const double zx = h * 0.3 * 0.35 * std::cos(0.35 * x);
    const double zy = -h * 0.2 * 0.4 * std::sin(0.4 * y);
    const Eigen::Vector3d up = Eigen::Vector3d(-zx, -zy, 1.0).normalized();
    const Eigen::Vector3d left = up.cross(Eigen::Vector3d(std::cos(yaw), std::sin(yaw), 0.0)).normalized();
    Eigen::Matrix3d R;
    R << left.cross(up), left, up;
    return make_pose(R, {x, y, z});
  }

  void place() {
    T_world_ground_ = surface_pose(0.0, 0.0, 0.0);
    start_ = key_pose_ = previous_pose_ = T_world_body_ = body_pose();
    placed_ = true;
  }

  Eigen::Isometry3d body_pose() const {
    const Eigen::Vector2d rocking = rock(to_seconds(now_));
    return T_world_ground_ * make_pose(rotation_from_rpy(rocking.x(), rocking.y(), 0.0), Eigen::Vector3d::Zero()) *
           Eigen::Translation3d(0.0, 0.0, test_vehicle().origin_height_m);
  }

  void tick() {
    if (!placed_) place();
    constexpr double dt = 0.02;
    const Eigen::Isometry3d before = T_world_body_;
    const Twist twist = command(to_seconds(now_));
    const double ground_speed_mps = twist.speed_mps * (1.0 - slip(to_seconds(now_)));
    const double scrub_radps = scrub(to_seconds(now_));
    yaw_ += (twist.rate_radps + scrub_radps) * dt;
    if (scrub_radps != 0.0) scrub_steer_rad_ += 0.2 * dt;
    const Eigen::Vector3d forward = T_world_ground_.linear().col(0) * ground_speed_mps * dt;
    T_world_ground_ = surface_pose(T_world_ground_.translation().x() + forward.x(),
                                   T_world_ground_.translation().y() + forward.y(), yaw_);
    T_world_body_ = body_pose();
    driven_m_ += (T_world_body_.translation() - before.translation()).norm();
    now_ += kTickUs;
    make_imu(before, dt);
    make_wheels(twist, dt);
    if (now_ % 400'000 == 0) make_visual();
    while (!pending_.empty() && pending_.front().release <= now_) {
      localization.add_visual_motion(pending_.front().motion);
      pending_.pop_front();
    }
    if (!process_stalled) localization.step(now_);
  }

  void make_imu(const Eigen::Isometry3d& before, double dt) {
    ImuSample s;
    s.utime = now_;
    s.dt_s = dt;
    const Eigen::Vector3d rotation = log_so3(before.linear().transpose() * T_world_body_.linear());
    s.delta_angle_rad = rotation + gyro_bias_ * dt + noise_.gyro * std::sqrt(dt) * normal3();
    s.fog_delta_yaw_rad = rotation.z() + gyro_bias_z_fog_ * dt + noise_.fog * std::sqrt(dt) * normal();
    const Eigen::Vector3d velocity = (T_world_body_.translation() - before.translation()) / dt;
    const Eigen::Vector3d force = (velocity - velocity_) + Eigen::Vector3d(0.0, 0.0, 3.71 * dt);
    velocity_ = velocity;
    s.delta_velocity_mps = before.linear().transpose() * force + noise_.force * std::sqrt(dt) * normal3();
    corrupt_imu(s);
    if (imu_on) localization.add_imu(s);
  }

  // Steering angles at which no wheel slips laterally.
  void make_wheels(const Twist& twist, double dt) {
    const Vehicle v = test_vehicle();
    WheelSample s;
    s.utime = now_;
    for (size_t i = 0; i < 6; ++i) {
      const double vx = twist.speed_mps - twist.rate_radps * v.wheel_y_m[i];
      const double vy = twist.rate_radps * v.wheel_x_m[i];
      const bool steered = v.wheel_x_m[i] != 0.0;
      double angle = steered && std::hypot(vx, vy) > 1e-9 ? std::atan2(vy, vx) : 0.0;
      double speed = steered ? std::hypot(vx, vy) : vx;
      if (std::abs(angle) > 0.5 * kPi) {
        angle = wrap_angle(angle + kPi);
        speed = -speed;
      }
      drive_angle_[i] += speed / v.wheel_radius_m * dt;
      s.drive_angle_rad[i] = drive_angle_[i] + noise_.encoder_rad * normal();
      s.drive_rate_radps[i] = speed / v.wheel_radius_m;
      if (steered) s.steer_angle_rad[i < 2 ? i : i - 2] = angle + scrub_steer_rad_;
    }
    if (wheels_on) localization.add_wheels(s);
    WheelCommand c{now_, now_ + 100'000, s.drive_rate_radps};
    localization.add_wheel_command(c);
  }

  bool keyframe_out_of_view() const {
    const Eigen::Isometry3d moved = key_pose_.inverse() * previous_pose_;
    return moved.translation().norm() > 0.35 || log_so3(moved.linear()).norm() > 0.3;
  }

  // Like visual odometry: the errors of one keyframe telescope.
  void make_visual() {
    if (key_utime_ == kNever || keyframe_out_of_view()) {
      key_utime_ = previous_utime_ == kNever ? now_ : previous_utime_;
      key_pose_ = previous_pose_;
      key_error_ = previous_error_ = Eigen::Isometry3d::Identity();
      if (previous_utime_ == kNever) {
        previous_utime_ = now_;
        key_pose_ = previous_pose_ = T_world_body_;
        return;
      }
    }
    if (!visual_on) return;
    VisualMotion m;
    m.utime = now_;
    m.previous_utime = previous_utime_;
    m.keyframe_utime = key_utime_;
    if (!visual_lost) {
      const Eigen::Isometry3d error = make_pose(exp_so3(noise_.visual_rad * normal3()), noise_.visual_m * normal3());
      const Eigen::Isometry3d T_key_prev = key_pose_.inverse() * previous_pose_ * previous_error_;
      Eigen::Isometry3d T_key_cur = key_pose_.inverse() * T_world_body_ * error;
      m.T_prev_cur = T_key_prev.inverse() * T_key_cur;
      m.T_prev_cur.translation() *= 1.0 + scale_;
      m.T_prev_cur = T_true_nominal_.inverse() * m.T_prev_cur * T_true_nominal_;
      m.cov.setZero();
      m.cov.diagonal().head<3>().setConstant(noise_.visual_m * noise_.visual_m);
      m.cov.diagonal().tail<3>().setConstant(noise_.visual_rad * noise_.visual_rad);
      m.status = VisualStatus::kOk;
      previous_error_ = error;
      previous_pose_ = T_world_body_;
      previous_utime_ = now_;
    }
    corrupt_visual(m);
    pending_.push_back({now_ + 240'000, m});
  }

  DriveNoise noise_;
  WheelOdometry wheels_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  Eigen::Vector3d gyro_bias_;
  double gyro_bias_z_fog_ = 0.0;
  double scale_ = 0.0;
  Eigen::Isometry3d T_true_nominal_ = Eigen::Isometry3d::Identity();  // body axes, as the camera is mounted
  Utime now_ = 0;
  double yaw_ = 0.0;
  double scrub_steer_rad_ = 0.0;
  bool placed_ = false;
  double driven_m_ = 0.0;
  Eigen::Isometry3d T_world_ground_;  // where the wheels roll
  Eigen::Isometry3d T_world_body_;
  Eigen::Isometry3d start_;
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  std::array<double, 6> drive_angle_{};
  Utime key_utime_ = kNever;
  Utime previous_utime_ = kNever;
  Eigen::Isometry3d key_pose_;
  Eigen::Isometry3d previous_pose_;
  Eigen::Isometry3d key_error_ = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d previous_error_ = Eigen::Isometry3d::Identity();
  std::deque<PendingMotion> pending_;
};

}  // namespace rover::loc
