#include "hazard_detector/node.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <rover/hazards_t.hpp>

#include "common/bus/convert.hpp"
#include "common/core/frames.hpp"
#include "test/stereo/one_node_world.hpp"
#include "test/stereo/synthetic_world.hpp"
#include "test/trajectory_control/bus_world.hpp"

namespace rover::hazard {
namespace {

const std::string kConfig = std::string(ROVER_SOURCE_DIR) + "/config";

disparity_t disparity_of(const synthetic::World& world) {
  const StereoCamera camera = synthetic::loccam_camera();
  std::mt19937_64 random(1);
  disparity_t message{};
  disparity_to(synthetic::noisy_disparity(synthetic::exact_disparity(world, camera), camera, 0.2, 0.05, random), camera,
               message);
  return message;
}

class HazardNodeTest : public testing::Test {
 protected:
  HazardNodeTest() : world_("hazard_detector"), detector_(make_hazard_detector(world_.node(), kConfig)) {
    world_.record(channel::kHazards, hazards_);
  }

  void send_disparity(const disparity_t& message, Utime utime) {
    world_.send(channel::kDisparity, message, utime);
    world_.tick(utime);
  }

  test::OneNodeWorld world_;
  std::shared_ptr<HazardNode> detector_;
  std::vector<hazards_t> hazards_;
};

TEST_F(HazardNodeTest, PublishesOneMapPerDisparityWithItsExposureTimeAfterTheLatency) {
  synthetic::World world;
  world.rocks = {{1.8, 0.1, 0.2, 0.25}};
  send_disparity(disparity_of(world), 100'000);
  world_.tick(200'000);
  ASSERT_EQ(hazards_.size(), 1u);
  const hazards_t& h = hazards_[0];
  EXPECT_EQ(h.header.utime, 100'000);
  EXPECT_EQ(h.header.release_utime, 160'000);
  EXPECT_EQ(h.state, +hazards_t::HAZARD);
  EXPECT_NEAR(h.nearest_hazard_m, 1.65, 0.15);
  EXPECT_EQ(h.size, h.cells_x * h.cells_y);
  const int ix = static_cast<int>((1.8 - h.origin_x_m) / h.cell_m),
            iy = static_cast<int>((0.1 - h.origin_y_m) / h.cell_m);
  EXPECT_EQ(h.cells[static_cast<size_t>(iy * h.cells_x + ix)], +hazards_t::OBSTACLE);
}

TEST_F(HazardNodeTest, FrameWithoutStereoIsPublishedAsBlind) {
  disparity_t message = disparity_of({});
  std::fill(message.disparity_px16.begin(), message.disparity_px16.end(), +disparity_t::INVALID);
  send_disparity(message, 100'000);
  world_.tick(200'000);
  ASSERT_EQ(hazards_.size(), 1u);
  EXPECT_EQ(hazards_[0].state, +hazards_t::BLIND);
  EXPECT_TRUE(std::all_of(hazards_[0].cells.begin(), hazards_[0].cells.end(),
                          [](int cell) { return cell == hazards_t::UNSEEN; }));
}

// As through a fogged lens: a few wrong matches, high above the ground.
TEST_F(HazardNodeTest, NoiseInAPictureWithoutStereoIsNoHazard) {
  disparity_t message = disparity_of({});
  const int valid = message.width / 8 * message.height / 8;
  std::mt19937_64 random(2);
  std::fill(message.disparity_px16.begin(), message.disparity_px16.end(), +disparity_t::INVALID);
  for (int i = 0; i < valid; ++i) message.disparity_px16[random() % message.disparity_px16.size()] = 16 * 90;
  send_disparity(message, 100'000);
  world_.tick(200'000);
  ASSERT_EQ(hazards_.size(), 1u);
  EXPECT_EQ(hazards_[0].state, +hazards_t::BLIND);
  EXPECT_EQ(hazards_[0].hazard_px, 0);
}

TEST_F(HazardNodeTest, FramesOfADisplacedLocCamAreBlind) {
  vo_motion_t motion{};
  for (const auto status : {vo_motion_t::OK, vo_motion_t::DISPLACED, vo_motion_t::OK}) {
    motion.status = status;
    const Utime utime = world_.node().now() + 100'000;
    world_.send(channel::kVo, motion, utime);
    world_.tick(utime + 20'000);
    send_disparity(disparity_of({}), utime + 40'000);
    world_.tick(utime + 200'000);
  }
  ASSERT_EQ(hazards_.size(), 3u);
  EXPECT_EQ(hazards_[0].state, +hazards_t::CLEAR);
  EXPECT_EQ(hazards_[1].state, +hazards_t::BLIND);
  EXPECT_EQ(hazards_[2].state, +hazards_t::CLEAR);
}

TEST_F(HazardNodeTest, HeartbeatNamesTheDisplacementThatFollowsDarkness) {
  std::vector<heartbeat_t> heartbeats;
  world_.record(channel::kHeartbeat, heartbeats);
  disparity_t dark = disparity_of({});
  std::fill(dark.disparity_px16.begin(), dark.disparity_px16.end(), +disparity_t::INVALID);
  vo_motion_t motion{};
  const auto text_after = [&](std::int8_t status, const disparity_t& message) {
    motion.status = status;
    const Utime utime = world_.node().now() + 1'000'000;
    world_.send(channel::kVo, motion, utime);
    world_.tick(utime);
    send_disparity(message, utime + 20'000);
    world_.tick(utime + 980'000);
    return heartbeats.back().text;
  };
  world_.tick(0);
  EXPECT_EQ(text_after(vo_motion_t::OK, dark), "too little stereo");
  EXPECT_EQ(text_after(vo_motion_t::DISPLACED, dark), "LocCam displaced");
  EXPECT_EQ(text_after(vo_motion_t::OK, disparity_of({})), "");
}

// The process before it may have known that the LocCam is displaced.
TEST(HazardRestartTest, BeforeTheFirstVisualOdometryARestartedNodeIsBlind) {
  test::BusWorld world;
  Node node({.name = "hazard_detector", .boot_id = 2}, world.bus);
  const auto detector = make_hazard_detector(node, kConfig);
  const auto hazards = world.listen<hazards_t>(channel::kHazards);
  const auto look = [&] {
    world.send(channel::kDisparity, disparity_of({}));
    for (int i = 0; i < 10; ++i) world.tick(node);
    while (world.bus.handleTimeout(0) > 0) {
    }
    return static_cast<int>(hazards->back().state);
  };
  world.tick(node);
  EXPECT_EQ(look(), +hazards_t::BLIND);
  vo_motion_t motion{};
  motion.status = vo_motion_t::OK;
  world.send(channel::kVo, motion);
  world.tick(node);
  EXPECT_EQ(look(), +hazards_t::CLEAR);
}

TEST_F(HazardNodeTest, MalformedDisparitiesAreCountedAndIgnored) {
  std::vector<disparity_t> bad(6, disparity_of({}));
  bad[0].focal_px = kNaN;
  bad[1].baseline_m = 0.0;
  bad[2].width = 511;
  bad[3].quat_body_cam_wxyz[0] = 0.0;
  bad[3].quat_body_cam_wxyz[1] = bad[3].quat_body_cam_wxyz[2] = bad[3].quat_body_cam_wxyz[3] = 0.0;
  bad[4].position_body_cam_m[2] = kNaN;
  bad[5].cx_px = kInfinity;
  Utime t = 100'000;
  for (const disparity_t& message : bad) send_disparity(message, t += 100'000);
  world_.tick(t + 100'000);
  EXPECT_TRUE(hazards_.empty());
  EXPECT_EQ(world_.malformed(channel::kDisparity), 6);
  send_disparity(disparity_of({}), t + 200'000);
  ASSERT_EQ(hazards_.size(), 1u);
  EXPECT_EQ(hazards_[0].state, +hazards_t::CLEAR);
}

class HazardConfigTest : public testing::Test {
 protected:
  HazardConfigTest() : dir_(std::filesystem::path(testing::TempDir()) / "hazard_config") {
    std::filesystem::remove_all(dir_);
    std::filesystem::create_directories(dir_);
    for (const char* file : {"vehicle.yaml", "navigation.yaml", "hazard_detector.yaml"})
      std::filesystem::copy_file(kConfig + "/" + file, dir_ / file);
  }
  void write(const std::string& file, const std::string& text) { std::ofstream(dir_ / file) << text; }

  std::filesystem::path dir_;
};

TEST_F(HazardConfigTest, ObstacleThresholdIsTheVehicleHazardHeight) {
  const NodeConfig config = load_config(dir_.string());
  EXPECT_DOUBLE_EQ(config.core.obstacle_height_m, 0.15);
  EXPECT_DOUBLE_EQ(config.core.origin_height_m, 0.62);
  EXPECT_DOUBLE_EQ(config.core.plane.front_axle_x_m, 0.75);
  EXPECT_FALSE(config.core.calibration);
}

TEST_F(HazardConfigTest, CalibrationFileIsReadIfPresent) {
  write(kCalibrationFile, "height_m: 0.70\npitch_deg: 34.0\nroll_deg: -0.5\n");
  const NodeConfig config = load_config(dir_.string());
  ASSERT_TRUE(config.core.calibration);
  EXPECT_NEAR(config.core.calibration->pitch_rad, to_rad(34.0), 1e-12);
  write(kCalibrationFile, "height_m: 0.70\npitch_deg: 34.0\n");
  EXPECT_THROW(load_config(dir_.string()), ConfigError);
}

TEST_F(HazardConfigTest, UnknownKeysAndWrongRangesStopTheStart) {
  const std::string sections = "grid: {}\nplane: {}\nlocal_ground: {}\n";
  write("hazard_detector.yaml", sections);
  EXPECT_NO_THROW(load_config(dir_.string()));
  for (const char* bad : {"limits: {hole_depth: 0.1}\n", "limits: {hole_depth_m: -1}\n", "limits: {near_m: 0.1}\n",
                          "coverage: {min_coverage: 0.0}\n", "relief: {}\n"}) {
    write("hazard_detector.yaml", sections + bad);
    EXPECT_THROW(load_config(dir_.string()), ConfigError) << bad;
  }
}

}  // namespace
}  // namespace rover::hazard
