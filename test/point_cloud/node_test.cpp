#include "point_cloud/node.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <rover/cloud_t.hpp>

#include "common/bus/convert.hpp"
#include "test/point_cloud/navcam_world.hpp"
#include "test/stereo/one_node_world.hpp"

namespace rover::cloud {
namespace {

const std::string kConfig = std::string(ROVER_SOURCE_DIR) + "/config";

// Shared by all tests, as rendering is slow.
const synthetic::RawPair& image_pair() {
  static const synthetic::RawPair kPair = render_pair({}, to_rad(30.0), to_rad(10.0));
  return kPair;
}

image_t message_of(const GrayImage& image) {
  image_t message{};
  image_to(image, message);
  return message;
}

class PointCloudNodeTest : public testing::Test {
 protected:
  PointCloudNodeTest()
      : world_("point_cloud"),
        service_(make_point_cloud(world_.node(), kConfig)),
        left_(message_of(image_pair().left)),
        right_(message_of(image_pair().right)) {
    world_.record(channel::kCloud, clouds_);
  }

  void send_state(Utime utime, bool moving = false, double pan_rad = to_rad(30.0)) {
    ptu_state_t state{};
    state.pan_rad = pan_rad;
    state.tilt_rad = to_rad(10.0);
    state.moving = moving ? 1 : 0;
    world_.send(channel::kPtuState, state, utime);
  }
  void send_pair(Utime utime) {
    world_.send(channel::kNavCamLeft, left_, utime);
    world_.send(channel::kNavCamRight, right_, utime);
  }
  // A single bit makes the pair differ from a frozen one.
  void change_images() {
    left_.data[0] ^= 1;
    right_.data[0] ^= 1;
  }
  std::int64_t rejected() { return world_.malformed(channel::kNavCamLeft); }

  test::OneNodeWorld world_;
  std::shared_ptr<PointCloudNode> service_;
  image_t left_, right_;
  std::vector<cloud_t> clouds_;
};

TEST_F(PointCloudNodeTest, PairWithUnitStateBecomesCloudOfItsExposure) {
  send_state(100'000);
  world_.tick(100'000);
  send_pair(100'000);
  world_.tick(160'000);
  world_.tick(400'000);
  ASSERT_EQ(clouds_.size(), 1u);
  const cloud_t& cloud = clouds_[0];
  EXPECT_EQ(cloud.header.utime, 100'000);
  EXPECT_EQ(cloud.header.release_utime, 360'000);
  EXPECT_GT(cloud.point_count, 2000);
  EXPECT_EQ(cloud.x_m.size(), static_cast<size_t>(cloud.point_count));
  EXPECT_LT(encoded(cloud).size(), 500'000u);
  const Eigen::Isometry3d T_body_cam = pose_from(cloud.position_body_cam_m, cloud.quat_body_cam_wxyz);
  double squares = 0.0;
  for (size_t i = 0; i < cloud.x_m.size(); ++i)
    squares += std::pow((T_body_cam * Eigen::Vector3d(cloud.x_m[i], cloud.y_m[i], cloud.z_m[i])).z() + 0.62, 2);
  EXPECT_LT(std::sqrt(squares / cloud.point_count), 0.02);
}

TEST_F(PointCloudNodeTest, NoCloudWithoutUnitStateOrWhileUnitMoves) {
  send_pair(100'000);
  world_.tick(160'000);
  send_state(200'000);
  send_state(500'000, true);
  world_.tick(500'000);
  change_images();
  send_pair(500'000);
  world_.tick(600'000);
  change_images();
  send_pair(900'000);
  world_.tick(1'000'000);
  world_.tick(1'300'000);
  EXPECT_TRUE(clouds_.empty());
  EXPECT_EQ(rejected(), 3);
}

TEST(PointCloudLatencyTest, APairThatWaitsForASlowOneKeepsItsUnitState) {
  test::OneNodeWorld world("point_cloud");
  NodeConfig config = load_config(kConfig);
  config.latency_us = 3'000'000;
  PointCloudNode service(world.node(), config);
  std::vector<cloud_t> clouds;
  world.record(channel::kCloud, clouds);
  image_t left = message_of(image_pair().left);
  image_t right = message_of(image_pair().right);
  for (Utime t = 80'000; t <= 3'400'000; t += kTickUs) {
    ptu_state_t state{};
    state.pan_rad = to_rad(30.0);
    state.tilt_rad = to_rad(10.0);
    world.send(channel::kPtuState, state, t);
    if (t == 100'000 || t == 200'000) {
      world.send(channel::kNavCamLeft, left, t);
      world.send(channel::kNavCamRight, right, t);
      left.data[0] ^= 1;
      right.data[0] ^= 1;
    }
    world.tick(t);
  }
  ASSERT_EQ(clouds.size(), 2u);
  EXPECT_EQ(clouds[1].header.utime, 200'000);
}

TEST_F(PointCloudNodeTest, FrozenAndUnpairedImagesAreRejected) {
  for (Utime t : {100'000, 600'000}) {
    send_state(t);
    world_.tick(t);
    send_pair(t);
    world_.tick(t + 60'000);
  }
  world_.tick(1'000'000);
  EXPECT_EQ(clouds_.size(), 1u);
  EXPECT_EQ(rejected(), 1);
  world_.send(channel::kNavCamLeft, left_, 1'100'000);
  world_.tick(1'100'000);
  world_.send(channel::kNavCamRight, right_, 1'200'000);
  world_.tick(1'300'000);
  world_.tick(1'600'000);
  EXPECT_EQ(clouds_.size(), 1u);
  EXPECT_EQ(rejected(), 2);
}

TEST_F(PointCloudNodeTest, InvalidUnitStatesAreCounted) {
  send_state(100'000, false, kNaN);
  send_state(120'000, false, 3.0);
  world_.tick(120'000);
  send_pair(120'000);
  world_.tick(200'000);
  world_.tick(500'000);
  EXPECT_EQ(world_.malformed(channel::kPtuState), 2);
  EXPECT_TRUE(clouds_.empty());
}

TEST_F(PointCloudNodeTest, TexturelessImagesGiveEmptyCloud) {
  std::fill(left_.data.begin(), left_.data.end(), std::uint8_t{90});
  right_ = left_;
  send_state(100'000);
  world_.tick(100'000);
  send_pair(100'000);
  world_.tick(160'000);
  world_.tick(500'000);
  ASSERT_EQ(clouds_.size(), 1u);
  EXPECT_EQ(clouds_[0].point_count, 0);
}

TEST(PointCloudConfigTest, TestNavCamEqualsShippedConfig) {
  const NodeConfig config = load_config(kConfig);
  EXPECT_TRUE(config.rig.T_body_left.isApprox(navcam_rig().T_body_left, 1e-12));
  EXPECT_TRUE(config.unit.p_body_axes.isApprox(navcam_unit().p_body_axes, 1e-12));
  EXPECT_EQ(config.core.matcher.residual_min_px, PointCloudConfig{}.matcher.residual_min_px);
}

TEST(PointCloudConfigTest, UnknownKeysBadRangesAndVehicleWithoutUnitThrow) {
  const auto dir = std::filesystem::path(testing::TempDir()) / "point_cloud_config";
  std::filesystem::remove_all(dir);
  std::filesystem::create_directories(dir);
  for (const char* file : {"vehicle.yaml", "cameras.yaml"})
    std::filesystem::copy_file(kConfig + "/" + file, dir / file);
  for (const char* text : {"filter: {voxel: 1}\n", "matcher: {block_px: 4}\n", "max_depth_m: 1\nmin_depth_m: 2\n",
                           "foreground_fattening: {width_px: -1}\n", "rims: {}\n", "sample_m: 0.02\n"}) {
    std::ofstream(dir / "point_cloud.yaml") << text;
    EXPECT_THROW(load_config(dir.string()), ConfigError) << text;
  }
  std::ofstream(dir / "point_cloud.yaml") << "matcher: {}\nforeground_fattening: {}\nfilter: {}\n";
  EXPECT_NO_THROW(load_config(dir.string()));
  std::ifstream shipped(dir / "vehicle.yaml");
  std::stringstream text;
  text << shipped.rdbuf();
  std::ofstream(dir / "vehicle.yaml") << text.str().substr(0, text.str().find("pan_tilt:"));
  EXPECT_THROW(load_config(dir.string()), ConfigError);
}

}  // namespace
}  // namespace rover::cloud
