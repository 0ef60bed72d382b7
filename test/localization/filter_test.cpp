#include "localization/filter.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

namespace rover::loc {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kGravity = 3.71;
constexpr double kOriginHeightM = 0.6;

MotionRecord record_at(Utime start, const Vector3d& rate, const Vector3d& force) {
  MotionRecord r;
  r.start = start;
  r.end = start + kTickUs;
  r.gyro_valid = r.fog_valid = r.force_valid = true;
  r.delta_angle_rad = rate * 0.02;
  r.delta_velocity_mps = force * 0.02;
  return r;
}

Filter make_filter() {
  Filter filter({}, kOriginHeightM);
  filter.set_gravity(kGravity);
  return filter;
}

TEST(Filter, GravityUpdateCorrectsTiltOnly) {
  const Filter filter = make_filter();
  FilterState state = filter.initial_state(0, rotation_from_rpy(0.008, -0.01, 0.5), Vector3d::Zero());
  for (int i = 0; i < 50 * 600; ++i)
    state =
        filter.propagate(state, record_at(state.utime, Vector3d::Zero(), {0, 0, kGravity}), Eigen::Vector2d::Zero());
  const Vector3d rpy = rpy_of(state.T_odom_body.linear());
  EXPECT_NEAR(rpy.x(), 0.0, 1e-3);
  EXPECT_NEAR(rpy.y(), 0.0, 1e-3);
  EXPECT_NEAR(rpy.z(), 0.5, 2e-3);
  EXPECT_LT(state.T_odom_body.translation().norm(), 0.005) << "a tilt about the ground";
}

TEST(Filter, ZeroRateUpdateFindsGyroBias) {
  const Filter filter = make_filter();
  FilterState state = filter.initial_state(0, Matrix3d::Identity(), Vector3d::Zero());
  const Vector3d bias(5e-5, -3e-5, 1e-5);
  for (int i = 0; i < 50 * 120; ++i) {
    MotionRecord r = record_at(state.utime, bias, {0, 0, kGravity});
    r.stationary = r.settled = true;
    state = filter.propagate(state, r, Eigen::Vector2d::Zero());
  }
  EXPECT_LT((state.gyro_bias_radps - bias).norm(), 5e-6);
  EXPECT_NEAR(state.gyro_bias_radps.z(), bias.z(), 6e-7) << "the fibre-optic gyro is more precise";
  EXPECT_LT(std::sqrt(state.P(kBias + 2, kBias + 2)), 1.5e-6);
  EXPECT_TRUE(state.T_odom_body.linear().isIdentity(1e-12)) << "no rotation while stationary";
}

TEST(Filter, ZeroRateUpdateWithoutFibreOpticGyroKeepsItsBias) {
  const Filter filter = make_filter();
  FilterState state = filter.initial_state(0, Matrix3d::Identity(), Vector3d::Zero());
  const double before = state.P(kBias + 2, kBias + 2);
  for (int i = 0; i < 50 * 60; ++i) {
    MotionRecord r = record_at(state.utime, {5e-5, 0.0, 1e-4}, {0, 0, kGravity});
    r.stationary = r.settled = true;
    r.fog_valid = false;
    state = filter.propagate(state, r, Eigen::Vector2d::Zero());
  }
  EXPECT_EQ(state.gyro_bias_radps.z(), 0.0);
  EXPECT_GE(state.P(kBias + 2, kBias + 2), before);
  EXPECT_NEAR(state.gyro_bias_radps.x(), 5e-5, 5e-6);
}

// Wheels roll below the origin, so a body that tips forward moves its origin by height times angle.
TEST(Filter, BodyTurnsAboutTheGround) {
  const Filter filter = make_filter();
  FilterState state = filter.initial_state(0, Matrix3d::Identity(), Vector3d::Zero());
  for (int i = 0; i < 50; ++i)
    state = filter.propagate(state, record_at(state.utime, {0.0, 0.1, 0.0}, {0, 0, kGravity}), {0.002, 0.0});
  EXPECT_NEAR(state.T_odom_body.translation().x(), 0.1 + kOriginHeightM * 0.1, 2e-3);
  EXPECT_NEAR(state.T_odom_body.translation().y(), 0.0, 1e-9);
}

// The slip since the newest visual motion is an error per metre, the rest is random.
TEST(Filter, UncertaintyOfWheelOdometryGrowsWithTheDistanceBridged) {
  const Filter filter = make_filter();
  const FilterConfig config;
  FilterState state = filter.initial_state(0, Matrix3d::Identity(), Vector3d::Zero());
  const auto sigma_after = [&](double distance_m) {
    while (state.dead_reckoned_m < distance_m - 1e-9)
      state = filter.propagate(state, record_at(state.utime, Vector3d::Zero(), {0, 0, kGravity}), {0.004, 0.0});
    return std::sqrt(state.P(kPosition, kPosition));
  };
  const auto expected = [&](double m) {
    return std::hypot(config.wheel_noise_m_rtm * std::sqrt(m), config.slip_sigma * m);
  };
  EXPECT_NEAR(sigma_after(0.08), expected(0.08), 1e-4);
  EXPECT_NEAR(sigma_after(2.0), expected(2.0), 1e-3);
  const VisualInterval visual{state.utime, state.utime + kTickUs, Eigen::Isometry3d::Identity(),
                              Matrix6d::Identity() * 1e-8};
  const auto fused = filter.fuse_visual(state, {record_at(state.utime, Vector3d::Zero(), {0, 0, kGravity})}, visual);
  ASSERT_TRUE(fused.has_value());
  EXPECT_EQ(fused->dead_reckoned_m, 0.0);
}

TEST(Filter, VisualMotionIsInAxesAtItsStart) {
  const Filter filter = make_filter();
  const FilterState state = filter.initial_state(0, rotation_from_rpy(0.0, 0.0, kPi / 2), Vector3d::Zero());
  std::vector<MotionRecord> records;
  for (Utime t = 0; t < 400'000; t += kTickUs) records.push_back(record_at(t, Vector3d::Zero(), {0, 0, kGravity}));
  VisualInterval visual{0, 400'000, make_pose(Matrix3d::Identity(), {0.08, 0.0, 0.0}), Matrix6d::Identity() * 1e-8};
  const auto fused = filter.fuse_visual(state, records, visual);
  ASSERT_TRUE(fused.has_value());
  EXPECT_NEAR(fused->T_odom_body.translation().y(), 0.08, 1e-6);
  EXPECT_NEAR(fused->T_odom_body.translation().x(), 0.0, 1e-6);
  EXPECT_EQ(fused->utime, 400'000);
}

// Images that err in rotation also err in lateral translation, through their covariance.
TEST(Filter, GyroCorrectsTranslationThroughCovariance) {
  const Filter filter = make_filter();
  const FilterState state = filter.initial_state(0, Matrix3d::Identity(), Vector3d::Zero());
  std::vector<MotionRecord> records;
  for (Utime t = 0; t < 400'000; t += kTickUs) records.push_back(record_at(t, Vector3d::Zero(), {0, 0, kGravity}));
  constexpr double kYawError = 0.002;
  constexpr double kLever = 1.5;  // m: distance of the points, whose rotation looks like lateral motion
  Matrix6d cov = Matrix6d::Identity() * 1e-10;
  cov(5, 5) = kYawError * kYawError;
  cov(1, 1) += kLever * kLever * cov(5, 5);
  cov(1, 5) = cov(5, 1) = -kLever * cov(5, 5);
  const Eigen::Isometry3d visual = make_pose(rotation_from_rpy(0.0, 0.0, kYawError), {0.08, -kLever * kYawError, 0.0});
  const auto fused = filter.fuse_visual(state, records, {0, 400'000, visual, cov});
  ASSERT_TRUE(fused.has_value());
  EXPECT_NEAR(fused->T_odom_body.translation().y(), 0.0, 2e-4);
  EXPECT_NEAR(yaw_of(fused->T_odom_body), 0.0, 1e-4);
}

// Half a circle over waves, seen by a camera whose mounting is turned by `mounting_rad` (body axes).
FilterState half_circle(double mounting_sigma_rad, const Vector3d& mounting_rad) {
  FilterConfig config;
  config.mounting_sigma_rad = mounting_sigma_rad;
  Filter filter(config, kOriginHeightM);
  filter.set_gravity(kGravity);
  FilterState state = filter.initial_state(0, Matrix3d::Identity(), Vector3d::Zero());
  const Matrix3d R_true_nominal = exp_so3(mounting_rad);
  for (int n = 0; n < 60; ++n) {
    const Matrix3d R = rotation_from_rpy(0.03 * std::cos(0.4 * n), 0.02 * std::cos(0.3 * n), kPi / 60);
    std::vector<MotionRecord> records;
    for (int i = 0; i < 20; ++i)
      records.push_back(record_at(state.utime + i * kTickUs, log_so3(R) / 0.4, {0, 0, kGravity}));
    for (MotionRecord& record : records) record.force_valid = false;
    const Eigen::Isometry3d seen =
        make_pose(R_true_nominal.transpose() * R * R_true_nominal, R_true_nominal.transpose() * Vector3d(0.1, 0, 0));
    const auto fused =
        filter.fuse_visual(state, records, {state.utime, state.utime + 400'000, seen, Matrix6d::Identity() * 1e-8});
    if (!fused) throw std::runtime_error("rejected");
    state = *fused;
  }
  return state;
}

TEST(Filter, CovarianceHoldsTheMountingOfTheCamera) {
  constexpr double kSigma = 0.002;
  Eigen::Matrix<double, 6, 3> J;
  const FilterState exact = half_circle(kSigma, Vector3d::Zero());
  for (int axis = 0; axis < 3; ++axis) {
    const FilterState turned = half_circle(kSigma, 1e-4 * Vector3d::Unit(axis));
    J.col(axis) << turned.T_odom_body.translation() - exact.T_odom_body.translation(),
        log_so3(turned.T_odom_body.linear() * exact.T_odom_body.linear().transpose());
  }
  J /= 1e-4;
  const Matrix6d expected = kSigma * kSigma * J * J.transpose();
  const Matrix6d P = (exact.P - half_circle(0.0, Vector3d::Zero()).P).topLeftCorner<6, 6>();
  EXPECT_GT(std::sqrt(expected(0, 0)), 0.005) << "the end is 3.8 m to the left of the start";
  EXPECT_LT((P - expected).norm(), 0.05 * expected.norm()) << P << "\n\n" << expected;
}

TEST(Filter, RotationConflictIsRejected) {
  const Filter filter = make_filter();
  const FilterState state = filter.initial_state(0, Matrix3d::Identity(), Vector3d::Zero());
  std::vector<MotionRecord> records;
  for (Utime t = 0; t < 400'000; t += kTickUs) records.push_back(record_at(t, Vector3d::Zero(), {0, 0, kGravity}));
  const VisualInterval visual{0, 400'000, make_pose(rotation_from_rpy(0.0, 0.0, 0.1), {0.08, 0.0, 0.0}),
                              Matrix6d::Identity() * 1e-8};
  EXPECT_FALSE(filter.fuse_visual(state, records, visual).has_value());
}

TEST(Filter, CovarianceStaysSymmetricAndPositive) {
  const Filter filter = make_filter();
  FilterState state = filter.initial_state(0, Matrix3d::Identity(), Vector3d::Zero());
  for (int n = 0; n < 500; ++n) {
    std::vector<MotionRecord> records;
    for (int i = 0; i < 20; ++i)
      records.push_back(record_at(state.utime + i * kTickUs, {0.0, 0.0, 0.1}, {0, 0, kGravity}));
    const Matrix3d R = rotation_from_rpy(0.0, 0.0, 0.04);
    const auto fused = filter.fuse_visual(
        state, records,
        {state.utime, state.utime + 400'000, make_pose(R, {0.08, 0.0, 0.0}), Matrix6d::Identity() * 1e-7});
    ASSERT_TRUE(fused.has_value());
    state = *fused;
  }
  EXPECT_LT((state.P - state.P.transpose()).norm(), 1e-12);
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<ErrorCov>(state.P).eigenvalues().minCoeff(), -1e-12);
}

}  // namespace
}  // namespace rover::loc
