#include "slam/node.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <rover/elevation_t.hpp>
#include <rover/service_state_t.hpp>
#include <rover/slam_pose_t.hpp>

#include "common/bus/convert.hpp"
#include "test/slam/navcam.hpp"
#include "test/stereo/one_node_world.hpp"

namespace rover::slam {
namespace {

using namespace testing_support;

const std::string kConfig = std::string(ROVER_SOURCE_DIR) + "/config";
constexpr Utime kExposure = 200'000;

cloud_t message_of(const Cloud& cloud) {
  cloud_t message{};
  pose_to(cloud.T_body_cam, message.position_body_cam_m, message.quat_body_cam_wxyz);
  message.point_count = static_cast<std::int32_t>(cloud.points.size());
  for (const CameraPoint& point : cloud.points) {
    message.x_m.push_back(point.p_cam_m.x());
    message.y_m.push_back(point.p_cam_m.y());
    message.z_m.push_back(point.p_cam_m.z());
    message.depth_sigma_m.push_back(point.depth_sigma_m);
  }
  return message;
}

class SlamNodeTest : public testing::Test {
 protected:
  explicit SlamNodeTest(const std::string& run_dir = "")
      : world_("slam", run_dir), slam_(make_slam(world_.node(), kConfig)) {
    world_.record(channel::kElevation, elevations_);
    world_.record(channel::kSlamPose, poses_);
    world_.record(channel::kServiceState, states_);
  }

  void set_level(std::int8_t level) {
    supervisor_state_t state{};
    state.level = level;
    world_.send(channel::kState, state, now_);
  }
  // Publishes POSE at this pose for one second.
  void drive_to_and_wait(const Pose2& pose, const Pose2& T_map_odom = {100, 200, 0}) {
    for (int i = 0; i < 50; ++i) {
      now_ += kTickUs;
      pose_t message{};
      message.status = pose_t::OK;
      pose_to(upright(pose, kOriginHeightM), message.position_odom_body_m, message.quat_odom_body_wxyz);
      pose_to(from_planar(T_map_odom), message.position_map_odom_m, message.quat_map_odom_wxyz);
      matrix6_to(Matrix6d::Identity() * 1e-4, message.covariance);
      world_.send(channel::kPose, message, now_);
      world_.tick(now_);
    }
  }
  cloud_t view(const Pose2& pose, std::uint64_t seed = 1) {
    Random random(seed);
    return message_of(cloud_of(Ground{}, upright(pose, kOriginHeightM), NavcamModel{.step_px = 8}, random, 0));
  }
  void send_cloud(const cloud_t& cloud, Utime utime) {
    world_.send(channel::kCloud, cloud, utime, now_);
    for (int i = 0; i < 10; ++i) world_.tick(now_ += kTickUs);
  }

  test::OneNodeWorld world_;
  std::shared_ptr<SlamNode> slam_;
  std::vector<elevation_t> elevations_;
  std::vector<slam_pose_t> poses_;
  std::vector<service_state_t> states_;
  Utime now_ = 0;
};

TEST_F(SlamNodeTest, BrightnessIsPassedOnIfTheCloudHasIt) {
  set_level(supervisor_state_t::FULL);
  drive_to_and_wait({3, 4, 0.5});
  send_cloud(view({3, 4, 0.5}), now_ - kExposure);
  ASSERT_EQ(elevations_.size(), 1u);
  EXPECT_EQ(elevations_[0].picture_size, 0);
  cloud_t cloud = view({3, 4, 0.5}, 2);
  cloud.picture_size = cloud.point_count;
  cloud.brightness.assign(cloud.x_m.size(), 5000.0F);
  drive_to_and_wait({3, 4, 0.5});
  send_cloud(cloud, now_ - kExposure);
  ASSERT_EQ(elevations_.size(), 2u);
  const elevation_t& e = elevations_[1];
  ASSERT_EQ(e.picture_size, e.size);
  for (size_t i = 0; i < e.brightness.size(); ++i)
    if (!std::isnan(e.brightness[i])) {
      EXPECT_NEAR(e.brightness[i], 5000.0, 1.0);
      EXPECT_FALSE(std::isnan(e.height_m[i]));
    }
  cloud.picture_size = 1;
  cloud.brightness.resize(1);
  drive_to_and_wait({3, 4, 0.5});
  send_cloud(cloud, now_ - kExposure);
  EXPECT_EQ(elevations_.size(), 2u) << "brightness of other points";
}

TEST_F(SlamNodeTest, EachCloudGivesElevationAndPoseReleasedAfterLatency) {
  set_level(supervisor_state_t::FULL);
  drive_to_and_wait({3, 4, 0.5});
  const Utime exposed = now_ - kExposure;
  const Utime sent = now_ + kTickUs;
  send_cloud(view({3, 4, 0.5}), exposed);
  ASSERT_EQ(elevations_.size(), 1u);
  ASSERT_EQ(poses_.size(), 1u);
  const elevation_t& e = elevations_[0];
  EXPECT_EQ(e.header.utime, exposed);
  EXPECT_EQ(e.header.release_utime, sent + 100'000);
  EXPECT_EQ(e.cells_x, 200);
  EXPECT_EQ(e.cells_y, 200);
  EXPECT_EQ(e.size, 40'000);
  EXPECT_NEAR(e.origin_x_m + 10.0, 3.0, 0.11);
  EXPECT_NEAR(e.origin_y_m + 10.0, 4.0, 0.11);
  // In view: the true height; behind the rover: never seen.
  int correct = 0, seen = 0;
  for (int i = 0; i < e.size; ++i) {
    const float height = e.height_m[static_cast<size_t>(i)];
    EXPECT_EQ(std::isnan(height), std::isnan(e.sigma_m[static_cast<size_t>(i)]));
    if (std::isnan(height) || e.sigma_m[static_cast<size_t>(i)] > 0.03F) continue;
    const double x = e.origin_x_m + (i % 200 + 0.5) * e.cell_m, y = e.origin_y_m + (i / 200 + 0.5) * e.cell_m;
    ++seen;
    correct += std::abs(height - Ground{}(x, y)) < 0.08 ? 1 : 0;
    EXPECT_GT(between({3, 4, 0.5}, {x, y, 0}).x_m, 0.5);
  }
  EXPECT_GT(seen, 500);
  EXPECT_GT(correct, 0.9 * seen);
  EXPECT_EQ(poses_[0].status, +slam_pose_t::NO_INFORMATION);
  EXPECT_NEAR(poses_[0].x_m, 100.0, 0.01);
  EXPECT_NEAR(poses_[0].y_m, 200.0, 0.01);
}

TEST(DeadReckonedDistance, CountsOnlyMotionWithoutFreshVisualOdometry) {
  DeadReckonedDistance distance;
  pose_t pose{};
  const auto drive_to = [&](double travelled_m, Utime utime, Utime vo) {
    pose.travelled_m = travelled_m;
    pose.header.utime = utime;
    pose.last_vo_utime = vo;
    return distance.add(pose);
  };
  EXPECT_EQ(drive_to(5.0, 1'000'000, 500'000), 0.0);
  EXPECT_EQ(drive_to(5.1, 1'500'000, 900'000), 0.0);
  EXPECT_NEAR(drive_to(5.3, 2'500'000, 900'000), 0.2, 1e-12);
  EXPECT_NEAR(drive_to(5.4, 3'000'000, -1), 0.3, 1e-12);
  EXPECT_NEAR(drive_to(5.5, 3'100'000, 2'800'000), 0.3, 1e-12);
  EXPECT_NEAR(drive_to(0.0, 9'000'000, -1), 0.3, 1e-12);  // localization restarted
}

class OdometryGrowthTest : public testing::Test {
 protected:
  // The next POSE, `metres` on.
  Odometry drive(double metres, double sigma_m, Utime after = kTickUs) {
    pose_.header.utime += after;
    pose_.last_vo_utime = pose_.header.utime;
    pose_.travelled_m += metres;
    Odometry odometry{upright({pose_.travelled_m, 0, 0}, kOriginHeightM), sigma_m, 0.0};
    growth_.add(pose_, odometry);
    return odometry;
  }
  pose_t pose_{};
  OdometryGrowth growth_{1.0};
};

TEST_F(OdometryGrowthTest, WhatTheRoverIsToldIsNoErrorOfOdometry) {
  EXPECT_NEAR(drive(0.0, 0.3).position_sigma_m, 0.3, 1e-9);
  EXPECT_NEAR(drive(0.004, 0.31).position_sigma_m, 0.31, 1e-9);
  EXPECT_NEAR(drive(0.004, 100.0).position_sigma_m, 0.31, 1e-6) << "a start pose";
  EXPECT_NEAR(drive(0.004, std::hypot(100.0, 0.1)).position_sigma_m, std::hypot(0.31, 0.1), 1e-6);
  EXPECT_NEAR(drive(0.004, 0.2).position_sigma_m, std::hypot(0.31, 0.1), 1e-6) << "a fix";
  EXPECT_GT(drive(0.1, 0.4, 1'000'000).position_sigma_m, 0.4) << "a gap of POSE: odometry's own";
}

TEST_F(OdometryGrowthTest, TheWayToTheFirstPoseAfterARestartCountsAsDeadReckoned) {
  Odometry last{upright({0, 0, 0}, kOriginHeightM), 0.05, 0.0, 3.0};
  growth_.restore(last);
  const Odometry first = drive(0.4, 7.0);
  EXPECT_NEAR(first.dead_reckoned_m, 3.4, 1e-9);
  EXPECT_NEAR(first.position_sigma_m, 0.05, 1e-9);
  EXPECT_NEAR(drive(0.4, 7.0).dead_reckoned_m, 3.4, 1e-9);
}

TEST_F(SlamNodeTest, IdlesUnlessLevelIsFull) {
  drive_to_and_wait({});
  send_cloud(view({}), now_ - kExposure);
  set_level(supervisor_state_t::EFFICIENT);
  drive_to_and_wait({});
  send_cloud(view({}), now_ - kExposure);
  EXPECT_TRUE(elevations_.empty());
  EXPECT_TRUE(poses_.empty());
  set_level(supervisor_state_t::FULL);
  drive_to_and_wait({});
  send_cloud(view({}), now_ - kExposure);
  EXPECT_EQ(elevations_.size(), 1u);
}

TEST_F(SlamNodeTest, InvalidCloudsAreCountedAndNextValidOneIsUsed) {
  set_level(supervisor_state_t::FULL);
  drive_to_and_wait({});
  const cloud_t good = view({});
  std::vector<cloud_t> bad(7, good);
  bad[0].x_m[5] = std::numeric_limits<float>::quiet_NaN();
  bad[1].depth_sigma_m[3] = 0.0F;
  bad[2].z_m[9] = std::numeric_limits<float>::infinity();
  bad[3].quat_body_cam_wxyz[0] = 7.0;
  bad[4].position_body_cam_m[1] = kNaN;
  bad[5] = message_of({.T_body_cam = NavcamModel{}.T_body_cam()});  // empty
  bad[6].z_m[0] = -1.0F;
  for (const cloud_t& message : bad) send_cloud(message, now_ - kExposure);
  drive_to_and_wait({});
  EXPECT_TRUE(elevations_.empty());
  EXPECT_EQ(world_.malformed(channel::kCloud), 7);
  send_cloud(good, now_ - kExposure);
  EXPECT_EQ(elevations_.size(), 1u);
}

TEST_F(SlamNodeTest, FutureCloudsAndCloudsOlderThanPoseHistoryAreRejected) {
  set_level(supervisor_state_t::FULL);
  drive_to_and_wait({});
  for (int i = 0; i < 6; ++i) drive_to_and_wait({});
  send_cloud(view({}), now_ - 6'500'000);
  send_cloud(view({}), now_ + 60'000'000);
  drive_to_and_wait({});
  EXPECT_TRUE(elevations_.empty());
  EXPECT_EQ(world_.malformed(channel::kCloud), 2);
}

TEST_F(SlamNodeTest, SingleOdometryJumpIsRejectedAndMapIsKept) {
  set_level(supervisor_state_t::FULL);
  drive_to_and_wait({});
  send_cloud(view({}), now_ - kExposure);
  drive_to_and_wait({40, 0, 0});
  send_cloud(view({}), now_ - kExposure);
  EXPECT_EQ(elevations_.size(), 1u);
  drive_to_and_wait({0.2, 0, 0});
  send_cloud(view({0.2, 0, 0}), now_ - kExposure);
  ASSERT_EQ(elevations_.size(), 2u);
  EXPECT_EQ(world_.malformed(channel::kCloud), 1);
  EXPECT_NEAR(elevations_[1].origin_x_m, -10.0, 0.3);
  EXPECT_EQ(poses_[1].status, +slam_pose_t::OK);
}

TEST_F(SlamNodeTest, LostCloudGivesNoElevation) {
  set_level(supervisor_state_t::FULL);
  drive_to_and_wait({});
  send_cloud(view({}), now_ - kExposure);
  for (const size_t elevations : {1u, 1u, 2u}) {  // the third one restarts the map
    drive_to_and_wait({});
    send_cloud(view({30, 0, 0}, 2), now_ - kExposure);
    EXPECT_EQ(poses_.back().status, +slam_pose_t::LOST);
    EXPECT_EQ(elevations_.size(), elevations);
  }
  EXPECT_EQ(poses_.size(), 4u);
}

TEST_F(SlamNodeTest, CloudWithinAGapOfPoseIsRejected) {
  set_level(supervisor_state_t::FULL);
  drive_to_and_wait({});
  now_ += 1'000'000;
  drive_to_and_wait({});
  send_cloud(view({}), now_ - 1'500'000);
  EXPECT_TRUE(poses_.empty());
  send_cloud(view({}), now_ - kExposure - 10'000);
  EXPECT_EQ(poses_.size(), 1u) << "between two POSE of 20 ms";
}

TEST_F(SlamNodeTest, FollowsPoseAfterExternalCorrection) {
  set_level(supervisor_state_t::FULL);
  drive_to_and_wait({});
  send_cloud(view({}), now_ - kExposure);
  drive_to_and_wait({0.2, 0, 0}, {101, 199, 0.02});
  send_cloud(view({0.2, 0, 0}, 2), now_ - kExposure);
  ASSERT_EQ(poses_.size(), 2u);
  EXPECT_NEAR(poses_[1].x_m, 101.0, 0.03);
  EXPECT_NEAR(poses_[1].y_m, 199.0, 0.03);
  EXPECT_NEAR(poses_[1].yaw_rad, 0.02, 0.005);
}

class SlamRestartTest : public SlamNodeTest {
 protected:
  SlamRestartTest() : SlamNodeTest(folder()) {}
  static std::string folder() {
    const auto dir = std::filesystem::path(testing::TempDir()) / "slam_restart";
    std::filesystem::create_directories(dir);
    return dir.string();
  }
  static void SetUpTestSuite() { std::filesystem::remove_all(folder()); }
};

// The two tests run in this order: the second reads the checkpoint of the first.
TEST_F(SlamRestartTest, FirstProcessSavesMap) {
  set_level(supervisor_state_t::FULL);
  drive_to_and_wait({});
  send_cloud(view({}), now_ - kExposure);
  drive_to_and_wait({});
  EXPECT_TRUE(states_.empty());
}

TEST_F(SlamRestartTest, SecondProcessRestoresMap) {
  now_ = 10'000'000;
  set_level(supervisor_state_t::FULL);
  drive_to_and_wait({0.3, 0, 0});
  ASSERT_EQ(states_.size(), 1u);
  EXPECT_LT(states_[0].size, 900'000);
  send_cloud(view({0.3, 0, 0}, 2), now_ - kExposure);
  ASSERT_EQ(poses_.size(), 1u);
  // Without the restored map there would be nothing to match against.
  EXPECT_EQ(poses_[0].status, +slam_pose_t::OK);
}

TEST(SlamConfigTest, UnknownKeysAndBadRangesThrow) {
  const auto dir = std::filesystem::path(testing::TempDir()) / "slam_config";
  std::filesystem::create_directories(dir);
  const auto write = [&](const std::string& text) { std::ofstream(dir / "slam.yaml") << text; };
  write("seed: 3\n");
  EXPECT_EQ(load_config(dir.string()).core.seed, 3u);
  for (const char* bad : {"map: {cell: 0.1}\n", "map: {cell_m: -1}\n", "match: {blur_m: 0.01}\n",
                          "filter: {min_particles: 300, max_particles: 200}\n"}) {
    write(bad);
    EXPECT_THROW(load_config(dir.string()), ConfigError) << bad;
  }
}

TEST(SlamConfigTest, ShippedFileLoads) {
  const NodeConfig config = load_config(kConfig);
  EXPECT_EQ(config.core.map.cells, 200);
  EXPECT_DOUBLE_EQ(config.core.map.patches.cell_m, 0.1);
}

}  // namespace
}  // namespace rover::slam
