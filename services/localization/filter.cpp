#include "localization/filter.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace rover::loc {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using ErrorVector = Eigen::Matrix<double, kErrorSize, 1>;

double square(double x) {
  return x * x;
}

void inject_error(FilterState& state, const ErrorVector& error) {
  state.T_odom_body.translation() += error.segment<3>(kPosition);
  state.T_odom_body.linear() = exp_so3(error.segment<3>(kAttitude)) * state.T_odom_body.linear();
  state.gyro_bias_radps += error.segment<3>(kBias);
}

// Part of the error state that a measurement corrects; the rest are consider states (Schmidt-Kalman).
struct StateBlock {
  int first;
  int count;
};

// Kalman update with residual r = H error + noise, in Joseph form.
template <int N>
void update(FilterState& state, const Eigen::Matrix<double, N, kErrorSize>& H, const Eigen::Matrix<double, N, 1>& r,
            const Eigen::Matrix<double, N, N>& R, StateBlock block) {
  const Eigen::Matrix<double, N, N> S = H * state.P * H.transpose() + R;
  Eigen::Matrix<double, kErrorSize, N> K = state.P * H.transpose() * S.inverse();
  K.topRows(block.first).setZero();
  K.bottomRows(kErrorSize - block.first - block.count).setZero();
  const ErrorCov I_KH = ErrorCov::Identity() - K * H;
  state.P = I_KH * state.P * I_KH.transpose() + K * R * K.transpose();
  inject_error(state, K * r);
}

// Gyro rotation and specific force integrated over records.
struct GyroRotation {
  Matrix3d R = Matrix3d::Identity();
  double gyro_s = 0.0;                    // time with gyro, over which the bias acts
  Vector3d force_sum = Vector3d::Zero();  // of specific force times time, axes of the body at the start
  double force_s = 0.0;
};

GyroRotation integrate_gyro(const std::vector<MotionRecord>& records, const Vector3d& bias) {
  GyroRotation g;
  for (const MotionRecord& r : records) {
    if (r.force_valid) {
      g.force_sum += g.R * r.delta_velocity_mps;
      g.force_s += r.dt_s();
    }
    if (r.stationary) continue;
    if (!r.gyro_valid) {
      g.R = g.R * exp_so3({0.0, 0.0, r.wheel_motion.z()});
      continue;
    }
    g.R = g.R * exp_so3(r.delta_angle_rad - bias * r.dt_s());
    g.gyro_s += r.dt_s();
  }
  return g;
}

constexpr double kSmallestVariance = 1e-12;  // rad^2, keeps the innovation covariance regular
constexpr int kVisualPosition = kErrorSize;
constexpr int kVisualRotation = kErrorSize + 3;
constexpr int kGyro = kErrorSize + 6;
constexpr int kJoint = kErrorSize + 9;
using JointCov = Eigen::Matrix<double, kJoint, kJoint>;
using JointVector = Eigen::Matrix<double, kJoint, 1>;

}  // namespace

FilterState Filter::initial_state(Utime utime, const Matrix3d& R_odom_body, const Vector3d& gyro_bias) const {
  FilterState state;
  state.utime = utime;
  state.T_odom_body.linear() = R_odom_body;
  state.gyro_bias_radps = gyro_bias;
  constexpr double kTiltSigmaRad = 0.005;  // accelerometer bias of a few mg
  state.P.diagonal().segment<2>(kAttitude).setConstant(square(kTiltSigmaRad));
  state.P.diagonal().segment<2>(kBias).setConstant(square(config_.gyro_bias_sigma_radps));
  state.P(kBias + 2, kBias + 2) = square(config_.fog_bias_sigma_radps);
  state.P(kScale, kScale) = square(config_.visual_scale_sigma);
  state.P.diagonal().segment<3>(kMounting).setConstant(square(config_.mounting_sigma_rad));
  return state;
}

FilterState Filter::propagate(FilterState state, const MotionRecord& record, const Eigen::Vector2d& ground_m) const {
  const double dt = record.dt_s();
  const Matrix3d R = state.T_odom_body.linear();
  const bool rotating = !record.stationary;
  const bool gyro = record.gyro_valid && rotating;
  if (rotating) {
    const Vector3d rotation = gyro ? Vector3d(record.delta_angle_rad - state.gyro_bias_radps * dt)
                                   : Vector3d(0.0, 0.0, record.wheel_motion.z());
    state.T_odom_body.linear() = R * exp_so3(rotation);
  }
  const Vector3d displacement = R.leftCols<2>() * ground_m + origin_height_m_ * (state.T_odom_body.linear() - R).col(2);
  ErrorCov F = ErrorCov::Identity();
  F.block<3, 3>(kPosition, kAttitude) = -skew(displacement);
  if (gyro) F.block<3, 3>(kAttitude, kBias) = -R * dt;
  state.P = F * state.P * F.transpose();
  const double dead_reckoned_m = state.dead_reckoned_m + ground_m.norm();
  const double position_noise = square(config_.wheel_noise_m_rtm) * ground_m.norm() +
                                square(config_.slip_sigma) * (square(dead_reckoned_m) - square(state.dead_reckoned_m));
  const Matrix3d rotation_noise = R * rotation_variance(record).asDiagonal() * R.transpose();
  state.P.diagonal().segment<3>(kPosition).array() += position_noise;
  state.P.block<3, 3>(kAttitude, kAttitude) += rotation_noise;
  state.noise_m2 += position_noise;
  state.noise_rad2 += rotation_noise(2, 2);
  state.dead_reckoned_m = dead_reckoned_m;
  add_bias_random_walk(state, dt);
  state.T_odom_body.translation() += displacement;
  state.utime = record.end;
  if (record.settled && record.gyro_valid) update_gyro_bias(state, record);
  if (record.force_valid) update_tilt(state, R * record.delta_velocity_mps / dt, dt);
  return state;
}

Vector3d Filter::gyro_variance(const MotionRecord& record) const {
  const double z = record.fog_valid ? config_.fog_noise_rad_rts : config_.no_fog_noise_rad_rts;
  return Vector3d(square(config_.gyro_noise_rad_rts), square(config_.gyro_noise_rad_rts), square(z)) * record.dt_s();
}

// Variance of the body's rotation over a record, body axes.
Vector3d Filter::rotation_variance(const MotionRecord& record) const {
  if (record.stationary) return Vector3d::Zero();
  const double dt = record.dt_s();
  if (!record.gyro_valid) return Vector3d::Constant(square(config_.no_gyro_noise_rad_rts) * dt);
  return gyro_variance(record);
}

void Filter::add_bias_random_walk(FilterState& state, double dt_s) const {
  const Vector3d walk(config_.gyro_bias_walk_radps_rts, config_.gyro_bias_walk_radps_rts,
                      config_.fog_bias_walk_radps_rts);
  state.P.diagonal().segment<3>(kBias) += walk.cwiseAbs2() * dt_s;
}

// Zero angular rate update: a settled body's gyros measure their bias; z only if the fibre-optic gyro is valid.
// Position and heading are consider states: their correlation with the bias would move a stationary rover by metres.
void Filter::update_gyro_bias(FilterState& state, const MotionRecord& record) const {
  Eigen::Matrix<double, 3, kErrorSize> H = Eigen::Matrix<double, 3, kErrorSize>::Zero();
  H.block<3, 3>(0, kBias).setIdentity();
  const double dt = record.dt_s();
  const Vector3d r = record.delta_angle_rad / dt - state.gyro_bias_radps;
  const Matrix3d R = (gyro_variance(record) / square(dt)).asDiagonal();
  update<3>(state, H, r, R, {kBias, record.fog_valid ? 3 : 2});
}

// Gravity update: (1 + [d]x) R f must be (0, 0, g) on average, with attitude error d and d x g z = (d_y g, -d_x g).
void Filter::update_tilt(FilterState& state, const Vector3d& mean_force_odom, double duration_s) const {
  Eigen::Matrix<double, 2, kErrorSize> H = Eigen::Matrix<double, 2, kErrorSize>::Zero();
  H(0, kAttitude + 1) = gravity_mps2_;
  H(1, kAttitude) = -gravity_mps2_;
  const Eigen::Matrix2d R = square(config_.force_noise_mps2_rthz) / duration_s * Eigen::Matrix2d::Identity();
  update<2>(state, H, -mean_force_odom.head<2>(), R, {kAttitude, 6});
}

std::optional<FilterState> Filter::fuse_visual(const FilterState& at_from, const std::vector<MotionRecord>& records,
                                               const VisualInterval& visual) const {
  const GyroRotation gyro = integrate_gyro(records, at_from.gyro_bias_radps);
  JointCov joint = JointCov::Zero();
  joint.topLeftCorner<kErrorSize, kErrorSize>() = at_from.P;
  joint.block<6, 6>(kVisualPosition, kVisualPosition) = visual.cov;
  joint.diagonal().segment<3>(kVisualPosition).array() += square(config_.visual_floor_m);
  joint.diagonal().segment<3>(kGyro).setConstant(kSmallestVariance);
  for (const MotionRecord& r : records) joint.diagonal().segment<3>(kGyro) += rotation_variance(r);

  // A camera turned by m sees the motion (R, t) as (R + [(R - 1) m]x R, t + [t]x m); its lever arm is left out.
  const Matrix3d rotation_by_mounting = visual.T_from_to.linear() - Matrix3d::Identity();
  // Innovation of the rotations: visual error - gyro error (bias error times time, plus noise).
  Eigen::Matrix<double, 3, kJoint> H = Eigen::Matrix<double, 3, kJoint>::Zero();
  H.block<3, 3>(0, kBias) = -gyro.gyro_s * Matrix3d::Identity();
  H.block<3, 3>(0, kMounting) = rotation_by_mounting;
  H.block<3, 3>(0, kVisualRotation).setIdentity();
  H.block<3, 3>(0, kGyro) = -Matrix3d::Identity();
  const Vector3d residual = log_so3(visual.T_from_to.linear() * gyro.R.transpose());
  const Matrix3d S = H * joint * H.transpose();
  const Matrix3d S_inv = S.inverse();
  if (residual.norm() > config_.max_rotation_conflict_rad &&
      residual.dot(S_inv * residual) > square(config_.max_rotation_conflict_sigma))
    return std::nullopt;
  // The filter's errors are consider states (Schmidt): calibration biases every visual rotation the same way, and a
  // filter that estimated gyro bias from it erred by 1 deg of yaw in 40 m.
  Eigen::Matrix<double, kJoint, 3> K = joint * H.transpose() * S_inv;
  K.topRows<kErrorSize>().setZero();
  const JointVector error = K * residual;
  const JointCov I_KH = JointCov::Identity() - K * H;
  joint = (I_KH * joint * I_KH.transpose()).eval();

  FilterState state = at_from;
  const Matrix3d R = state.T_odom_body.linear();
  const Vector3d displacement = R * (visual.T_from_to.translation() - error.segment<3>(kVisualPosition));
  const Matrix3d R_from_to = exp_so3(-error.segment<3>(kVisualRotation)) * visual.T_from_to.linear();
  state.T_odom_body.translation() += displacement;
  state.T_odom_body.linear() = R * R_from_to;
  state.utime = visual.to;
  state.dead_reckoned_m = 0.0;

  Eigen::Matrix<double, kErrorSize, kJoint> G = Eigen::Matrix<double, kErrorSize, kJoint>::Zero();
  G.topLeftCorner<kErrorSize, kErrorSize>().setIdentity();
  G.block<3, 3>(kPosition, kAttitude) = -skew(displacement);
  G.block<3, 1>(kPosition, kScale) = displacement;
  G.block<3, 3>(kPosition, kMounting) = -R * skew(visual.T_from_to.translation());
  G.block<3, 3>(kPosition, kVisualPosition) = -R;
  G.block<3, 3>(kAttitude, kMounting) = -R * rotation_by_mounting;
  G.block<3, 3>(kAttitude, kVisualRotation) = -R;
  state.P = G * joint * G.transpose();
  const Matrix3d position_noise = R * joint.block<3, 3>(kVisualPosition, kVisualPosition) * R.transpose();
  const Matrix3d rotation_noise = R * joint.block<3, 3>(kVisualRotation, kVisualRotation) * R.transpose();
  state.noise_m2 += 0.5 * position_noise.topLeftCorner<2, 2>().trace();
  state.noise_rad2 += rotation_noise(2, 2);
  add_bias_random_walk(state, to_seconds(visual.to - visual.from));
  for (const MotionRecord& r : records)
    if (r.settled && r.gyro_valid) update_gyro_bias(state, r);
  if (gyro.force_s > 0.0) update_tilt(state, R * gyro.force_sum / gyro.force_s, gyro.force_s);
  state.P = 0.5 * (state.P + state.P.transpose().eval());
  return state;
}

}  // namespace rover::loc
