#include "visual_odometry/node.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <rover/vo_motion_t.hpp>

#include "common/bus/checkpoint.hpp"
#include "common/bus/convert.hpp"
#include "common/core/state_bytes.hpp"
#include "synthetic_ground.hpp"
#include "test/stereo/one_node_world.hpp"

namespace rover::vo {
namespace {

using Eigen::Isometry3d;

const std::string kConfig = std::string(ROVER_SOURCE_DIR) + "/config";

class OdometryNodeTest : public testing::Test {
 protected:
  explicit OdometryNodeTest(const std::string& run_dir = "")
      : world_("visual_odometry", run_dir), node_(world_.node(), load_config(kConfig)), ground_(1) {
    world_.record(channel::kVo, motions_);
  }

  void send_pair(const Isometry3d& pose, Utime utime) {
    const StereoFrame frame = ground_.frame(utime, pose);
    image_t image{};
    image_to(frame.left, image);
    world_.send(channel::kLocCamRectLeft, image, utime);
    image_to(frame.right, image);
    world_.send(channel::kLocCamRectRight, image, utime);
    world_.send(channel::kDisparity, disparity_message(pose), utime);
  }

  disparity_t disparity_message(const Isometry3d& pose) {
    disparity_t message{};
    disparity_to(ground_.ground_disparity(pose), ground_.camera, message);
    return message;
  }

  // One pair every 0.4 s, IMU and tick every 0.02 s.
  void drive_to(const Isometry3d& pose, double yaw_rate) {
    for (int i = 0; i < 20; ++i) {
      now_ += kTickUs;
      imu_t imu{};
      imu.dt_s = 0.02;
      imu.delta_angle_rad[2] = imu.fog_delta_yaw_rad = yaw_rate * 0.02;
      if (imu_on_) world_.send(channel::kImu, imu, now_);
      if (i == 19) send_pair(pose, now_);
      world_.tick(now_);
    }
  }

  test::OneNodeWorld world_;
  OdometryNode node_;
  SyntheticGround ground_;
  std::vector<vo_motion_t> motions_;
  Utime now_ = 0;
  bool imu_on_ = true;
};

TEST_F(OdometryNodeTest, PublishesMotionAfterLatency) {
  const Isometry3d a = SyntheticGround::over_ground(0.0, 0.0, 0.0);
  const Isometry3d b = SyntheticGround::over_ground(0.05, 0.0, 0.1);
  drive_to(a, 0.0);
  drive_to(b, 0.25);
  ASSERT_EQ(motions_.size(), 1U);
  const vo_motion_t& m = motions_[0];
  EXPECT_EQ(m.header.utime, 800'000);
  EXPECT_EQ(m.header.release_utime, 800'000 + 120'000);
  EXPECT_EQ(m.previous_utime, 400'000);
  EXPECT_EQ(m.keyframe_utime, 400'000);
  EXPECT_EQ(m.status, int{vo_motion_t::OK});
  const Isometry3d T = pose_from(m.position_m, m.quat_wxyz);
  EXPECT_LT((T.translation() - (a.inverse() * b).translation()).norm(), 0.003);
  EXPECT_GT(m.covariance[0], 0.0);
}

TEST_F(OdometryNodeTest, WorksWithoutImu) {
  imu_on_ = false;
  drive_to(SyntheticGround::over_ground(0.0, 0.0, 0.0), 0.0);
  drive_to(SyntheticGround::over_ground(0.05, 0.0, 0.02), 0.0);
  ASSERT_EQ(motions_.size(), 1U);
  EXPECT_EQ(motions_[0].status, int{vo_motion_t::OK});
}

TEST_F(OdometryNodeTest, TexturelessFrameIsPublishedAsLost) {
  drive_to(SyntheticGround::over_ground(0.0, 0.0, 0.0), 0.0);
  ground_.textureless = true;
  drive_to(SyntheticGround::over_ground(0.08, 0.0, 0.0), 0.0);
  ASSERT_EQ(motions_.size(), 1U);
  EXPECT_EQ(motions_[0].status, int{vo_motion_t::LOST});
  EXPECT_TRUE(std::isnan(motions_[0].covariance[0]));
}

TEST_F(OdometryNodeTest, InvalidInputsAreCountedAndIgnored) {
  const Isometry3d a = SyntheticGround::over_ground(0.0, 0.0, 0.0);
  drive_to(a, 0.0);
  disparity_t nan_camera = disparity_message(a);
  nan_camera.focal_px = kNaN;
  world_.send(channel::kDisparity, nan_camera, now_);
  image_t short_image{};
  short_image.width = 512;
  short_image.height = 384;
  world_.send(channel::kLocCamRectLeft, short_image, now_);
  imu_t imu{};
  imu.dt_s = 0.02;
  imu.delta_angle_rad[0] = kNaN;
  world_.send(channel::kImu, imu, now_ + 1);
  drive_to(SyntheticGround::over_ground(0.08, 0.0, 0.0), 0.0);
  EXPECT_EQ(world_.malformed(channel::kDisparity), 1);
  EXPECT_EQ(world_.malformed(channel::kLocCamRectLeft), 1);
  EXPECT_EQ(world_.malformed(channel::kImu), 1);
  ASSERT_EQ(motions_.size(), 1U);
  EXPECT_EQ(motions_[0].status, int{vo_motion_t::OK});
}

// The folder of a process that noticed a knock.
class KnockedOdometryNodeTest : public OdometryNodeTest {
 protected:
  KnockedOdometryNodeTest() : OdometryNodeTest(knocked_folder()) {}
  ~KnockedOdometryNodeTest() override { std::filesystem::remove_all(knocked_folder()); }

  static std::string knocked_folder() {
    const std::string dir = testing::TempDir() + "/knocked_odometry";
    std::filesystem::create_directories(dir);
    StateWriter out;
    out.put(OffsetEvidence{100.0, 360.0});
    save_checkpoint(dir, "visual_odometry", out.take());
    return dir;
  }
};

// Motion alone shows it, and the rover may be stationary.
TEST_F(KnockedOdometryNodeTest, DisplacedCamerasAreDisplacedAfterARestart) {
  const std::string file = testing::TempDir() + "/knocked_odometry/visual_odometry.ckpt";
  std::filesystem::remove(file);
  drive_to(SyntheticGround::over_ground(0.0, 0.0, 0.0), 0.0);
  drive_to(SyntheticGround::over_ground(0.0, 0.0, 0.0), 0.0);
  ASSERT_EQ(motions_.size(), 1U);
  EXPECT_EQ(motions_[0].status, int{vo_motion_t::DISPLACED});
  EXPECT_TRUE(std::filesystem::exists(file)) << "saved for the next process";
}

TEST(OdometryConfigFile, MatchesDefaults) {
  const NodeConfig file = load_config(kConfig);
  const NodeConfig defaults;
  EXPECT_EQ(file.odometry.min_inliers, defaults.odometry.min_inliers);
  EXPECT_EQ(file.odometry.disparity_offset.information_factor, defaults.odometry.disparity_offset.information_factor);
  EXPECT_EQ(file.odometry.motion.pixel_sigma_px, defaults.odometry.motion.pixel_sigma_px);
  EXPECT_EQ(file.latency_s, defaults.latency_s);
}

}  // namespace
}  // namespace rover::vo
