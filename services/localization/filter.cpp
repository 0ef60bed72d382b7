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

void correct(FilterState& state, const ErrorVector& error) {
  state.T_odom_body.translation() += error.segment<3>(kPosition);
  state.T_odom_body.linear() = exp_so3(error.segment<3>(kAttitude)) * state.T_odom_body.linear();
  state.gyro_bias_radps += error.segment<3>(kBias);
}

// Part of the error state that a measurement may correct; the rest is only considered (Schmidt).
struct Part {
  int first;
  int count;
};

// Kalman update with residual r = H error + noise.
template <int N>
void update(FilterState& state, const Eigen::Matrix<double, N, kErrorSize>& H, const Eigen::Matrix<double, N, 1>& r,
            const Eigen::Matrix<double, N, N>& R, Part part) {
  const Eigen::Matrix<double, N, N> S = H * state.P * H.transpose() + R;
  Eigen::Matrix<double, kErrorSize, N> K = state.P * H.transpose() * S.inverse();
  K.topRows(part.first).setZero();
  K.bottomRows(kErrorSize - part.first - part.count).setZero();
  const ErrorCov I_KH = ErrorCov::Identity() - K * H;
  state.P = I_KH * state.P * I_KH.transpose() + K * R * K.transpose();
  correct(state, K * r);
}

// Rotation over records by gyro, and what is known about it.
struct GyroRotation {
  Matrix3d R = Matrix3d::Identity();
  double biased_s = 0.0;                  // time over which the bias acts
  double blind_s = 0.0;                   // time without a gyro
  Vector3d force_sum = Vector3d::Zero();  // specific force times time, axes of the body at the start
  double force_s = 0.0;
};

GyroRotation integrate(const std::vector<MotionRecord>& records, const Vector3d& bias) {
  GyroRotation g;
  for (const MotionRecord& r : records) {
    if (r.force) {
      g.force_sum += g.R * r.delta_velocity_mps;
      g.force_s += r.dt_s();
    }
    if (r.standing) continue;
    if (!r.gyro) {
      g.R = g.R * exp_so3({0.0, 0.0, r.wheel_motion.z()});
      continue;
    }
    g.R = g.R * exp_so3(r.delta_angle_rad - bias * r.dt_s());
    g.biased_s += r.dt_s();
  }
  return g;
}

constexpr double kSmallestVariance = 1e-12;  // rad^2, keeps the comparison of the two rotations regular
constexpr int kVisualPosition = kErrorSize;
constexpr int kVisualRotation = kErrorSize + 3;
constexpr int kGyro = kErrorSize + 6;
constexpr int kJoint = kErrorSize + 9;
using JointCov = Eigen::Matrix<double, kJoint, kJoint>;
using JointVector = Eigen::Matrix<double, kJoint, 1>;

}  // namespace

FilterState Filter::start(Utime utime, const Matrix3d& R_odom_body, const Vector3d& gyro_bias) const {
  FilterState state;
  state.utime = utime;
  state.T_odom_body.linear() = R_odom_body;
  state.gyro_bias_radps = gyro_bias;
  constexpr double kLevelSigma = 0.005;  // rad, accelerometer bias of a few mg
  state.P.diagonal().segment<2>(kAttitude).setConstant(square(kLevelSigma));
  state.P.diagonal().segment<2>(kBias).setConstant(square(config_.gyro_bias_sigma_radps));
  state.P(kBias + 2, kBias + 2) = square(config_.fog_bias_sigma_radps);
  state.P(kScale, kScale) = square(config_.visual_scale_sigma);
  return state;
}

FilterState Filter::advance(FilterState state, const MotionRecord& record, double grip) const {
  const double dt = record.dt_s();
  const Matrix3d R = state.T_odom_body.linear();
  const Vector3d moved = R * Vector3d(grip * record.wheel_motion.x(), grip * record.wheel_motion.y(), 0.0);
  const bool turning = !record.standing;
  const bool gyro = record.gyro && turning;
  ErrorCov F = ErrorCov::Identity();
  F.block<3, 3>(kPosition, kAttitude) = -skew(moved);
  if (gyro) F.block<3, 3>(kAttitude, kBias) = -R * dt;
  state.P = F * state.P * F.transpose();
  state.P.diagonal().segment<3>(kPosition).array() += square(config_.wheel_noise_m_rtm) * moved.norm();
  state.P.block<3, 3>(kAttitude, kAttitude) += R * angle_variance(record).asDiagonal() * R.transpose();
  wander(state, dt);
  state.T_odom_body.translation() += moved;
  if (turning) {
    const Vector3d turned = gyro ? Vector3d(record.delta_angle_rad - state.gyro_bias_radps * dt)
                                 : Vector3d(0.0, 0.0, record.wheel_motion.z());
    state.T_odom_body.linear() = R * exp_so3(turned);
  }
  state.utime = record.end;
  if (record.at_rest && record.gyro) rest(state, record);
  if (record.force) level(state, R * record.delta_velocity_mps / dt, dt);
  return state;
}

// Of the angles that the gyros measured over a record.
Vector3d Filter::gyro_variance(const MotionRecord& record) const {
  const double z = record.fog ? config_.fog_noise_rad_rts : config_.no_fog_noise_rad_rts;
  return Vector3d(square(config_.gyro_noise_rad_rts), square(config_.gyro_noise_rad_rts), square(z)) * record.dt_s();
}

// Of the rotation over a record, in body axes.
Vector3d Filter::angle_variance(const MotionRecord& record) const {
  if (record.standing) return Vector3d::Zero();
  const double dt = record.dt_s();
  if (!record.gyro) return Vector3d::Constant(square(config_.blind_rate_radps) * dt);
  return gyro_variance(record);
}

// Of the biases.
void Filter::wander(FilterState& state, double dt_s) const {
  const Vector3d walk(config_.gyro_bias_walk_radps_rts, config_.gyro_bias_walk_radps_rts,
                      config_.fog_bias_walk_radps_rts);
  state.P.diagonal().segment<3>(kBias) += walk.cwiseAbs2() * dt_s;
}

// At rest the gyros measure their bias; about z it is the fibre-optic gyro's, of which the other one tells nothing.
// Place and heading stay: what the bias did to them on a long drive shows up as metres by correlation, and a rover at
// rest must not move.
void Filter::rest(FilterState& state, const MotionRecord& record) const {
  Eigen::Matrix<double, 3, kErrorSize> H = Eigen::Matrix<double, 3, kErrorSize>::Zero();
  H.block<3, 3>(0, kBias).setIdentity();
  const double dt = record.dt_s();
  const Vector3d r = record.delta_angle_rad / dt - state.gyro_bias_radps;
  const Matrix3d R = (gyro_variance(record) / square(dt)).asDiagonal();
  update<3>(state, H, r, R, {kBias, record.fog ? 3 : 2});
}

// Gravity points down on average: R_true f = (1 + [d]x) R f has to be (0, 0, g), and d x g z = (d_y g, -d_x g).
void Filter::level(FilterState& state, const Vector3d& mean_force_odom, double duration_s) const {
  Eigen::Matrix<double, 2, kErrorSize> H = Eigen::Matrix<double, 2, kErrorSize>::Zero();
  H(0, kAttitude + 1) = gravity_mps2_;
  H(1, kAttitude) = -gravity_mps2_;
  const Eigen::Matrix2d R = square(config_.force_noise_mps2_rthz) / duration_s * Eigen::Matrix2d::Identity();
  update<2>(state, H, -mean_force_odom.head<2>(), R, {kAttitude, 6});
}

std::optional<FilterState> Filter::fuse_visual(const FilterState& at_from, const std::vector<MotionRecord>& records,
                                               const VisualInterval& visual) const {
  const GyroRotation gyro = integrate(records, at_from.gyro_bias_radps);
  JointCov joint = JointCov::Zero();
  joint.topLeftCorner<kErrorSize, kErrorSize>() = at_from.P;
  joint.block<6, 6>(kVisualPosition, kVisualPosition) = config_.visual_cov_factor * visual.cov;
  joint.diagonal().segment<3>(kVisualPosition).array() += square(config_.visual_floor_m);
  joint.diagonal().segment<3>(kGyro).setConstant(kSmallestVariance);
  for (const MotionRecord& r : records) joint.diagonal().segment<3>(kGyro) += angle_variance(r);

  // What the two rotations differ by: visual error - gyro error; the latter is the bias's error times time, and noise.
  Eigen::Matrix<double, 3, kJoint> H = Eigen::Matrix<double, 3, kJoint>::Zero();
  H.block<3, 3>(0, kBias) = -gyro.biased_s * Matrix3d::Identity();
  H.block<3, 3>(0, kVisualRotation).setIdentity();
  H.block<3, 3>(0, kGyro) = -Matrix3d::Identity();
  const Vector3d apart = log_so3(visual.T_from_to.linear() * gyro.R.transpose());
  const Matrix3d S = H * joint * H.transpose();
  const Matrix3d S_inv = S.inverse();
  if (apart.norm() > config_.max_rotation_conflict_rad &&
      apart.dot(S_inv * apart) > square(config_.max_rotation_conflict_sigma))
    return std::nullopt;
  // The state's own errors are only considered (Schmidt): calibration turns each visual motion a little the same way,
  // and a filter that trusted it over a long drive would take that for gyro bias.
  Eigen::Matrix<double, kJoint, 3> K = joint * H.transpose() * S_inv;
  K.topRows<kErrorSize>().setZero();
  const JointVector error = K * apart;
  const JointCov I_KH = JointCov::Identity() - K * H;
  joint = (I_KH * joint * I_KH.transpose()).eval();

  FilterState state = at_from;
  const Matrix3d R = state.T_odom_body.linear();
  const Vector3d moved = R * (visual.T_from_to.translation() - error.segment<3>(kVisualPosition));
  const Matrix3d turned = exp_so3(-error.segment<3>(kVisualRotation)) * visual.T_from_to.linear();
  state.T_odom_body.translation() += moved;
  state.T_odom_body.linear() = R * turned;
  state.utime = visual.to;

  Eigen::Matrix<double, kErrorSize, kJoint> G = Eigen::Matrix<double, kErrorSize, kJoint>::Zero();
  G.topLeftCorner<kErrorSize, kErrorSize>().setIdentity();
  G.block<3, 3>(kPosition, kAttitude) = -skew(moved);
  G.block<3, 1>(kPosition, kScale) = moved;
  G.block<3, 3>(kPosition, kVisualPosition) = -R;
  G.block<3, 3>(kAttitude, kVisualRotation) = -R;
  state.P = G * joint * G.transpose();
  wander(state, to_seconds(visual.to - visual.from));
  for (const MotionRecord& r : records)
    if (r.at_rest && r.gyro) rest(state, r);
  if (gyro.force_s > 0.0) level(state, R * gyro.force_sum / gyro.force_s, gyro.force_s);
  state.P = 0.5 * (state.P + state.P.transpose().eval());
  return state;
}

}  // namespace rover::loc
