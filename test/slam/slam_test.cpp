// SLAM as a whole, against known ground and simulated odometry.
#include "slam/slam.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "test/slam/navcam.hpp"

namespace rover::slam {
namespace {

using namespace testing_support;

// Drives over known ground with true motion and odometry given by the test.
class Drive {
 public:
  explicit Drive(const Ground& ground, std::uint64_t seed = 1, const SlamConfig& config = {})
      : ground_(ground), random_(seed), slam_(config) {}

  // One step of true and measured motion, then a cloud. `sigma_*`: growth of POSE's deviation;
  // `dead_reckoned_m`: part of the step without visual odometry.
  SlamResult step(const Pose2& motion, const Pose2& measured, double sigma_m = 0.0, double sigma_rad = 0.0,
                  double dead_reckoned_m = 0.0) {
    truth_ = compose(truth_, motion);
    odometry_ = compose(odometry_, measured);
    sigma_m_ += sigma_m;
    sigma_rad_ += sigma_rad;
    dead_reckoned_m_ += dead_reckoned_m;
    return look();
  }
  SlamResult look() {
    return slam_.step(view(), {upright(odometry_, kOriginHeightM), sigma_m_, sigma_rad_, dead_reckoned_m_});
  }
  Cloud view() {
    t_ += 2'500'000;
    return cloud_of(ground_, upright(truth_, kOriginHeightM), camera_, random_, t_);
  }
  void advance_time(Utime us) { t_ += us; }
  Pose2 error() const { return between(truth_, compose(slam_.T_slam_odom(), odometry_)); }
  double error_m() const { return std::hypot(error().x_m, error().y_m); }
  double odometry_error_m() const { return std::hypot(odometry_.x_m - truth_.x_m, odometry_.y_m - truth_.y_m); }
  Slam& slam() { return slam_; }
  Utime now() const { return t_; }
  const Pose2& odometry() const { return odometry_; }

 private:
  Ground ground_;
  NavcamModel camera_{.step_px = 8};
  Random random_;
  Slam slam_;
  Pose2 truth_, odometry_;
  double sigma_m_ = 0.0, sigma_rad_ = 0.0, dead_reckoned_m_ = 0.0;
  Utime t_ = 0;
};

TEST(Slam, EstimatesSuddenOdometryOffset) {
  Drive drive({});
  drive.look();
  for (int i = 0; i < 6; ++i) drive.step({0.5, 0, 0.02}, {0.5, 0, 0.02});
  // Odometry errs by 4 cm and 0.4 deg in one step and reports the larger uncertainty.
  const SlamResult result = drive.step({0.5, 0, 0}, {0.46, 0.03, to_rad(0.4)}, 0.03, to_rad(0.3));
  EXPECT_TRUE(result.rejection.empty());
  EXPECT_EQ(result.status, Status::kOk);
  EXPECT_GT(drive.odometry_error_m(), 0.04);
  EXPECT_LT(drive.error_m(), 0.02);
}

TEST(Slam, ReducesDriftFromOdometryScaleError) {
  Drive drive({});
  drive.look();
  for (int i = 0; i < 30; ++i) drive.step({0.5, 0, 0.01}, {0.51, 0.0, 0.01}, 0.01);
  EXPECT_GT(drive.odometry_error_m(), 0.28);
  EXPECT_LT(drive.error_m(), 0.6 * drive.odometry_error_m());
}

// The wheels slip by 6 % while visual odometry is lost.
TEST(Slam, DeadReckonedMotionGetsLargerNoise) {
  double error_m[2] = {};
  for (const bool reported : {false, true}) {
    Drive drive({});
    drive.look();
    for (int i = 0; i < 20; ++i) drive.step({0.5, 0, 0}, {0.53, 0.0, 0.0}, 0.0, 0.0, reported ? 0.5 : 0.0);
    error_m[reported] = drive.error_m();
  }
  EXPECT_GT(error_m[false], 0.2);
  EXPECT_LT(error_m[true], 0.1);
}

// Without the gyro the heading drifts, and POSE reports a growing deviation on top of the initial one.
TEST(Slam, HeadingWithoutGyroGetsLargerNoise) {
  double error_rad[2] = {};
  for (const bool reported : {false, true}) {
    Drive drive({});
    double sigma_rad = to_rad(0.25);
    drive.step({}, {}, 0.0, sigma_rad);
    for (int i = 0; i < 30; ++i) {
      const double before_rad = std::exchange(sigma_rad, std::hypot(sigma_rad, reported ? 3e-4 * std::sqrt(2.5) : 0.0));
      drive.step({0.5, 0, 0}, {0.5, 0, to_rad(0.025)}, 0.0, sigma_rad - before_rad);
    }
    error_rad[reported] = std::abs(drive.error().yaw_rad);
  }
  EXPECT_GT(error_rad[false], to_rad(0.6));
  EXPECT_LT(error_rad[true], 0.75 * error_rad[false]);
}

TEST(Slam, PerfectOdometryIsNotCorrupted) {
  Drive drive({});
  drive.look();
  for (int i = 0; i < 20; ++i) drive.step({0.5, 0, 0}, {0.5, 0, 0});
  EXPECT_LT(drive.error_m(), 0.05);
}

// After 40 m without clouds (Efficient level), the uncertainty of that drive must not spread the particles.
TEST(Slam, RestartsMapAfterRoverLeftIt) {
  Drive drive({});
  drive.look();
  for (int i = 0; i < 5; ++i) drive.step({0.5, 0, 0}, {0.5, 0, 0});
  drive.advance_time(120'000'000);
  const SlamResult first = drive.step({40.0, 0, 0}, {40.0, 0, 0}, 0.5, to_rad(0.5));
  EXPECT_TRUE(first.rejection.empty());
  EXPECT_LT(std::sqrt(first.covariance(0, 0)), 0.02);
  for (int i = 0; i < 12; ++i) {
    drive.step({0.5, 0, 0}, {0.5, 0, 0});
    EXPECT_LT(drive.error_m(), 0.05) << i;
  }
}

TEST(Slam, FlatGroundIsUnobservableAndFollowsOdometry) {
  Drive drive(Ground{0.0, 0.0});
  drive.look();
  int observable = 0;
  for (int i = 0; i < 20; ++i) {
    const SlamResult result = drive.step({0.5, 0, 0.01}, {0.5025, 0.001, 0.0101});
    observable += result.status == Status::kOk;
    EXPECT_EQ(result.information > 0.0, result.status == Status::kOk);
  }
  EXPECT_EQ(observable, 0);
  EXPECT_LT(drive.error_m(), 1.1 * drive.odometry_error_m() + 0.005);
}

// Wheels slip unseen along the ridges.
TEST(Slam, RidgesGiveNoInformationIfVisualOdometryHasAGap) {
  for (const bool gap : {false, true}) {
    Drive drive(Ground{0.0, 0.0, 0.05});
    drive.look();
    for (int i = 0; i < 6; ++i) {
      const SlamResult result = drive.step({0.2, 0, 0}, {0.2, 0, 0}, 0.0, 0.0, gap ? 0.2 : 0.0);
      EXPECT_EQ(result.status, Status::kOk);
      EXPECT_EQ(result.information > 0.0, !gap);
    }
    EXPECT_EQ(drive.look().information > 0.0, !gap) << "nothing is measured along the ridges while stationary";
    Slam restored({});
    ASSERT_TRUE(restored.restore(drive.slam().save()));
    const Odometry odometry{upright(drive.odometry(), kOriginHeightM), 0.0, 0.0, gap ? 1.2 : 0.0};
    EXPECT_EQ(restored.step(drive.view(), odometry).information > 0.0, !gap) << "nor does a restart";
  }
  Drive rocks({});
  rocks.look();
  EXPECT_GT(rocks.step({0.2, 0, 0}, {0.2, 0, 0}, 0.0, 0.0, 0.2).information, 0.0);
}

TEST(Slam, UniformSlopeIsUnobservable) {
  Drive drive(Ground{0.0, 0.15});
  drive.look();
  SlamResult result;
  for (int i = 0; i < 5; ++i) result = drive.step({0, 0, 0.1}, {0, 0, 0.1});
  EXPECT_EQ(result.status, Status::kNoInformation);
  EXPECT_EQ(result.information, 0.0);
}

// If a cloud were inserted before matching (as in GA SLAM), it would always fit best at the odometry pose.
TEST(Slam, CloudIsMatchedBeforeItIsInserted) {
  Drive drive({});
  const SlamResult first = drive.look();
  EXPECT_EQ(first.status, Status::kNoInformation);
  EXPECT_GT(drive.slam().map().seen_cells(), 1000);
  // Turned away from the mapped area: nothing to match, although the cloud is dense.
  const SlamResult away = drive.step({0, 0, 1.2}, {0, 0, 1.2});
  EXPECT_EQ(away.status, Status::kNoInformation);
}

TEST(Slam, SameSeedGivesIdenticalStateOtherSeedDiffers) {
  const auto run = [](std::uint64_t seed) {
    SlamConfig config;
    config.seed = seed;
    Drive drive({}, 1, config);
    drive.look();
    for (int i = 0; i < 5; ++i) drive.step({0.5, 0, 0.02}, {0.505, 0, 0.02});
    return drive.slam().save();
  };
  EXPECT_EQ(run(1), run(1));
  EXPECT_NE(run(1), run(2));
}

TEST(Slam, RestoredCheckpointContinuesIdentically) {
  Drive drive({});
  drive.look();
  for (int i = 0; i < 4; ++i) drive.step({0.5, 0, 0.02}, {0.505, 0, 0.02});
  const auto bytes = drive.slam().save();
  Slam other({});
  ASSERT_TRUE(other.restore(bytes));
  EXPECT_EQ(other.save(), bytes);
  const Cloud next = drive.view();
  const Odometry odometry{upright(drive.odometry(), kOriginHeightM), 0.0, 0.0};
  drive.slam().step(next, odometry);
  other.step(next, odometry);
  EXPECT_EQ(other.save(), drive.slam().save());
}

TEST(Slam, CorrectionDuringRestartIsAdopted) {
  for (const double correction_m : {0.0, 1.0}) {
    Drive drive({});
    const auto body = [&] { return upright(drive.odometry(), kOriginHeightM); };
    drive.slam().add_pose(1, upright({100, 50, 0.5}, 0.0), body());
    drive.look();
    drive.step({0.5, 0, 0.02}, {0.505, 0, 0.02});
    drive.slam().add_pose(drive.now(), upright({100, 50, 0.5}, 0.0), body());
    Slam other({});
    ASSERT_TRUE(other.restore(drive.slam().save()));
    const Eigen::Isometry3d T_map_odom = upright({100 + correction_m, 50, 0.5}, 0.0);
    for (Slam* slam : {&drive.slam(), &other})
      EXPECT_EQ(slam->add_pose(drive.now() + 1'000'000, T_map_odom, body()), correction_m > 0.0);
    EXPECT_EQ(other.save(), drive.slam().save());
  }
}

TEST(Slam, JumpSeenBeforeRestartIsConfirmedByTwoCloudsAfterIt) {
  Drive drive({});
  drive.look();
  for (int i = 0; i < 3; ++i) drive.step({0.5, 0, 0}, {0.5, 0, 0});
  const Odometry elsewhere{upright({50, 0, 0}, kOriginHeightM), 0.0, 0.0};
  EXPECT_FALSE(drive.slam().step(drive.view(), elsewhere).rejection.empty());
  Slam other({});
  ASSERT_TRUE(other.restore(drive.slam().save()));
  EXPECT_FALSE(other.step(drive.view(), elsewhere).rejection.empty());
  EXPECT_TRUE(other.step(drive.view(), elsewhere).rejection.empty());
}

// It is near the old place, so nothing jumps; the old ground is elsewhere in the new frame.
TEST(Slam, OdometryThatBeginsAnewRestartsTheMap) {
  Drive drive({});
  drive.look();
  for (int i = 0; i < 3; ++i) drive.step({0.5, 0, 0}, {0.5, 0, 0});
  Odometry odometry{upright(drive.odometry(), kOriginHeightM), 0.0, 0.0, 0.0, 40.0};
  drive.slam().step(drive.view(), odometry);
  odometry.travelled_m = 39.8;
  EXPECT_EQ(drive.slam().step(drive.view(), odometry).status, Status::kOk) << "a second of the odometer was lost";
  const int seen = drive.slam().map().seen_cells();
  odometry.travelled_m = 0.1;
  EXPECT_EQ(drive.slam().step(drive.view(), odometry).status, Status::kNoInformation);
  EXPECT_LT(drive.slam().map().seen_cells(), seen);
}

TEST(Slam, BrokenCheckpointIsRejectedWithoutSideEffects) {
  Drive drive({});
  drive.look();
  const auto bytes = drive.slam().save();
  Slam other({});
  for (const size_t length : {size_t{0}, size_t{3}, size_t{50}, bytes.size() / 2, bytes.size() - 1}) {
    EXPECT_FALSE(other.restore({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length)}));
    EXPECT_FALSE(other.running());
  }
  auto old_version = bytes;
  old_version[0] = 1;
  EXPECT_FALSE(other.restore(old_version));
  SlamConfig config;
  config.map.cells = 100;
  Slam smaller(config);
  EXPECT_FALSE(smaller.restore(bytes));
}

TEST(Slam, EmptyOldAndPoselessCloudsAreRejectedWithoutSideEffects) {
  Drive drive({});
  drive.look();
  drive.step({0.5, 0, 0}, {0.5, 0, 0});
  const auto before = drive.slam().save();
  const Odometry odometry{upright(drive.odometry(), kOriginHeightM), 0.0, 0.0};
  Cloud cloud = drive.view();
  Cloud empty = cloud;
  empty.points.clear();
  EXPECT_EQ(drive.slam().step(empty, odometry).rejection, "empty");
  Cloud old = cloud;
  old.utime = 1;
  EXPECT_EQ(drive.slam().step(old, odometry).rejection, "not newer than the one before");
  EXPECT_EQ(drive.slam().step(cloud, {}).rejection, "its pose is not finite");
  EXPECT_EQ(drive.slam().save(), before);
}

TEST(Slam, EmptyFirstCloudIsRejected) {
  Slam slam({});
  EXPECT_EQ(slam.step(Cloud{.utime = 5}, {upright({}, 0.6), 0.0, 0.0}).rejection, "empty");
  EXPECT_FALSE(slam.running());
}

TEST(Slam, SinglePoseJumpIsIgnored) {
  Drive drive({});
  drive.look();
  for (int i = 0; i < 3; ++i) drive.step({0.5, 0, 0}, {0.5, 0, 0});
  const int seen = drive.slam().map().seen_cells();
  const Odometry odd{upright({50, 0, 0}, kOriginHeightM), 0.0, 0.0};
  EXPECT_EQ(drive.slam().step(drive.view(), odd).rejection, "odometry has jumped");
  EXPECT_EQ(drive.slam().map().seen_cells(), seen);
  EXPECT_TRUE(drive.step({0.5, 0, 0}, {0.5, 0, 0}).rejection.empty());
  EXPECT_GE(drive.slam().map().seen_cells(), seen);
  EXPECT_LT(drive.error_m(), 0.05);
}

TEST(Slam, PersistentPoseJumpRestartsMap) {
  Drive drive({});
  drive.look();
  for (int i = 0; i < 3; ++i) drive.step({0.5, 0, 0}, {0.5, 0, 0});
  const Odometry elsewhere{upright({50, 0, 0}, kOriginHeightM), 0.0, 0.0};
  EXPECT_FALSE(drive.slam().step(drive.view(), elsewhere).rejection.empty());
  EXPECT_TRUE(drive.slam().step(drive.view(), elsewhere).rejection.empty());
  const OdomElevation elevation = drive.slam().elevation();
  EXPECT_NEAR(elevation.corner.ix * elevation.cell_m, 40.0, 0.11);
  EXPECT_NEAR(drive.slam().T_slam_odom().x_m, 0.0, 1e-3);
}

TEST(Slam, ElevationIsCorrectInOdomDespiteDrift) {
  Drive drive({});
  drive.look();
  for (int i = 0; i < 20; ++i) drive.step({0.5, 0, 0.0}, {0.52, 0.0, 0.001});
  const OdomElevation elevation = drive.slam().elevation();
  const Pose2 odometry = drive.odometry();
  // The ground 1 .. 5 m ahead must equal the true ground ahead of the true pose.
  int cells = 0;
  double mean = 0.0;
  const Ground ground;
  for (int row = 0; row < elevation.cells; ++row)
    for (int column = 0; column < elevation.cells; ++column) {
      const float height = elevation.height_m[static_cast<size_t>(row) * elevation.cells + column];
      const Pose2 center{(elevation.corner.ix + column + 0.5) * elevation.cell_m,
                         (elevation.corner.iy + row + 0.5) * elevation.cell_m, 0.0};
      const Pose2 seen = between(odometry, center);
      if (std::isnan(height) || seen.x_m < 1.0 || seen.x_m > 5.0 || std::abs(seen.y_m) > 1.5) continue;
      const Pose2 true_place = compose({10.0, 0.0, 0.0}, seen);
      mean += std::abs(height - ground(true_place.x_m, true_place.y_m));
      ++cells;
    }
  ASSERT_GT(cells, 400);
  EXPECT_LT(mean / cells, 0.03);
  EXPECT_GT(drive.odometry_error_m(), 0.3);
}

TEST(Slam, MapOfDifferentGroundIsDetectedAndRestarted) {
  Drive drive({});
  drive.look();
  for (int i = 0; i < 4; ++i) drive.step({0.5, 0, 0}, {0.5, 0, 0});
  // The rover is displaced by 30 m without odometry noticing.
  drive.step({30, 0, 0}, {0.0, 0, 0});
  std::vector<Status> seen;
  for (int i = 0; i < 4; ++i) seen.push_back(drive.look().status);
  EXPECT_EQ(seen[0], Status::kLost);
  EXPECT_NE(seen[3], Status::kLost);
  // The new map is level and at its height: a plane through its errors.
  const OdomElevation elevation = drive.slam().elevation();
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (int row = 0; row < elevation.cells; ++row)
    for (int column = 0; column < elevation.cells; ++column) {
      const float height = elevation.height_m[static_cast<size_t>(row) * elevation.cells + column];
      const Pose2 seen_at = between(drive.odometry(), {(elevation.corner.ix + column + 0.5) * elevation.cell_m,
                                                       (elevation.corner.iy + row + 0.5) * elevation.cell_m, 0.0});
      if (std::isnan(height) || seen_at.x_m > 5.0) continue;
      const Eigen::Vector3d basis(1.0, seen_at.x_m, seen_at.y_m);
      A += basis * basis.transpose();
      b += basis * (height - Ground{}(32.0 + seen_at.x_m, seen_at.y_m));
    }
  const Eigen::Vector3d plane = A.inverse() * b;
  EXPECT_LT(std::abs(plane(0)), 0.03);
  EXPECT_LT(plane.tail<2>().norm(), to_rad(0.3));
}

TEST(Slam, FollowsPoseAfterExternalCorrection) {
  Drive drive({});
  const auto pose = [&](Utime t, const Pose2& T_map_odom) {
    return drive.slam().add_pose(t, from_planar(T_map_odom), upright(drive.odometry(), kOriginHeightM));
  };
  pose(10, {100, 200, 0.5});
  drive.look();
  SlamResult result = drive.step({0.5, 0, 0}, {0.51, 0, 0});
  EXPECT_NEAR(result.T_map_odom.x_m, 100, 0.05);
  const Utime t = drive.now();
  pose(t, {100, 200, 0.5});
  EXPECT_TRUE(pose(t + kTickUs, {101.5, 199.0, 0.52}));
  result = drive.look();
  EXPECT_NEAR(result.T_map_odom.x_m, 101.5, 0.02);
  EXPECT_NEAR(result.T_map_odom.y_m, 199.0, 0.02);
  EXPECT_NEAR(result.T_map_odom.yaw_rad, 0.52, 0.005);
}

TEST(Slam, MapFollowsRoverWithConstantSize) {
  Drive drive({});
  drive.look();
  for (int i = 0; i < 60; ++i) drive.step({0.5, 0, 0}, {0.5, 0, 0});
  const OdomElevation elevation = drive.slam().elevation();
  EXPECT_EQ(elevation.height_m.size(), 40000u);
  EXPECT_NEAR((elevation.corner.ix + 100) * elevation.cell_m, 30.0, 0.2);
  EXPECT_LT(drive.slam().save().size(), 900'000u);
}

}  // namespace
}  // namespace rover::slam
