#include "pan_tilt/node.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <rover/path_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/ptu_command_t.hpp>
#include <rover/ptu_state_t.hpp>
#include <rover/supervisor_state_t.hpp>

#include "common/bus/convert.hpp"
#include "test/stereo/one_node_world.hpp"

namespace rover::gaze {
namespace {

const std::string kConfig = std::string(ROVER_SOURCE_DIR) + "/config";

class PanTiltNodeTest : public testing::Test {
 protected:
  PanTiltNodeTest() : world_("pan_tilt"), service_(make_pan_tilt(world_.node(), kConfig)) {
    world_.record(channel::kPtuCommand, commands_);
  }

  void send_state(std::int8_t level, std::int8_t state) {
    supervisor_state_t message{};
    message.level = level;
    message.state = state;
    world_.send(channel::kState, message, now_);
  }
  void send_pose(std::int8_t status = pose_t::OK) {
    pose_t message{};
    message.status = status;
    pose_to(from_planar({travelled_m_, 0.0, 0.0}), message.position_odom_body_m, message.quat_odom_body_wxyz);
    message.travelled_m = travelled_m_;
    world_.send(channel::kPose, message, now_);
  }
  void send_path(std::vector<double> x, std::vector<double> y, std::int8_t kind = path_t::CONTINUOUS) {
    path_t message{};
    message.frame = path_t::ODOM;
    message.kind = kind;
    message.point_count = static_cast<std::int32_t>(x.size());
    message.x_m = x;
    message.y_m = y;
    message.level.assign(x.size(), std::int8_t{path_t::FULL});
    message.direction.assign(x.size(),
                             kind == path_t::BACKTRACK ? std::int8_t{path_t::REVERSE} : std::int8_t{path_t::FORWARD});
    world_.send(channel::kPath, message, now_);
  }
  void tick() {
    world_.tick(now_);
    now_ += kTickUs;
  }
  void drive(double seconds, std::int8_t level, std::int8_t state = supervisor_state_t::DRIVING) {
    for (const Utime until = now_ + to_utime(seconds); now_ < until;) {
      travelled_m_ += 0.2 * 0.02;
      send_state(level, state);
      send_pose();
      ptu_state_t unit{};
      if (!commands_.empty()) {
        unit.pan_rad = commands_.back().pan_rad;
        unit.tilt_rad = commands_.back().tilt_rad;
      }
      world_.send(channel::kPtuState, unit, now_);
      tick();
    }
  }

  test::OneNodeWorld world_;
  std::shared_ptr<PanTiltNode> service_;
  std::vector<ptu_command_t> commands_;
  Utime now_ = 1'000'000;
  double travelled_m_ = 0.0;
};

TEST_F(PanTiltNodeTest, RequestsImagesOnlyAtTheFullLevel) {
  drive(10.0, supervisor_state_t::EFFICIENT);
  EXPECT_TRUE(commands_.empty());
  drive(10.1, supervisor_state_t::FULL);
  EXPECT_NEAR(static_cast<double>(commands_.size()), 5.0, 1.0);
  for (const ptu_command_t& command : commands_) EXPECT_EQ(command.take_image, 1);
  const size_t before = commands_.size();
  drive(10.0, supervisor_state_t::EFFICIENT);
  EXPECT_EQ(commands_.size(), before);
}

TEST_F(PanTiltNodeTest, LooksIntoBendButStraightAheadWhileBackingUp) {
  send_path({0.0, 2.0, 2.0}, {0.0, 0.0, 10.0});
  drive(0.2, supervisor_state_t::FULL);
  ASSERT_EQ(commands_.size(), 1u);
  EXPECT_GT(commands_[0].pan_rad, to_rad(40.0));
  send_path({0.0, -5.0}, {0.0, 0.0}, path_t::BACKTRACK);
  drive(3.0, supervisor_state_t::FULL);
  ASSERT_GE(commands_.size(), 2u);
  EXPECT_EQ(commands_[1].pan_rad, 0.0);
}

TEST_F(PanTiltNodeTest, SweepsInSweepingAndOnceWhenStoppedByHazards) {
  drive(6.0, supervisor_state_t::FULL, supervisor_state_t::SWEEPING);
  EXPECT_GE(commands_.size(), 10u);  // this unit arrives at once
  drive(1.0, supervisor_state_t::FULL);
  commands_.clear();
  drive(2.4, supervisor_state_t::FULL, supervisor_state_t::HAZARD_STOP);
  EXPECT_LE(commands_.size(), 1u);
  drive(4.0, supervisor_state_t::FULL, supervisor_state_t::REPAIRING);
  EXPECT_GE(commands_.size(), 10u);
}

TEST_F(PanTiltNodeTest, IdlesWithoutSupervisorState) {
  drive(1.0, supervisor_state_t::FULL);
  commands_.clear();
  for (int i = 0; i < 500; ++i) {
    travelled_m_ += 0.004;
    send_pose();
    tick();
  }
  EXPECT_LE(commands_.size(), 2u);  // before STATE is stale
}

TEST_F(PanTiltNodeTest, InvalidMessagesAreCountedAndIgnored) {
  send_path({0.0, kNaN}, {0.0, 10.0});
  send_path({0.0}, {0.0});
  ptu_state_t unit{};
  unit.pan_rad = kNaN;
  world_.send(channel::kPtuState, unit, now_);
  tick();
  travelled_m_ = kNaN;
  for (int i = 0; i < 20; ++i) {
    send_state(supervisor_state_t::FULL, supervisor_state_t::DRIVING);
    send_pose();
    tick();
  }
  EXPECT_EQ(world_.malformed(channel::kPath), 2);
  EXPECT_EQ(world_.malformed(channel::kPtuState), 1);
  EXPECT_TRUE(commands_.empty());
  travelled_m_ = 0.0;
  for (int i = 0; i < 20; ++i) {
    send_state(supervisor_state_t::FULL, supervisor_state_t::DRIVING);
    send_pose(pose_t::LOST);
    tick();
  }
  EXPECT_TRUE(commands_.empty());
  drive(0.2, supervisor_state_t::FULL);
  EXPECT_EQ(commands_.size(), 1u);
}

TEST(PanTiltConfigTest, UnknownKeysAndBadRangesThrow) {
  const auto dir = std::filesystem::path(testing::TempDir()) / "pan_tilt_config";
  std::filesystem::remove_all(dir);
  std::filesystem::create_directories(dir);
  for (const char* file : {"vehicle.yaml", "cameras.yaml"})
    std::filesystem::copy_file(kConfig + "/" + file, dir / file);
  for (const char* text : {"ahead: {}\nsweep: {pans: 3}\n", "image_distance_m: -1\nahead: {}\nsweep: {}\n",
                           "no_such_key: 0.5\n", "ahead: {near_m: 5, far_m: 4}\nsweep: {}\n"}) {
    std::ofstream(dir / "pan_tilt.yaml") << text;
    EXPECT_THROW(load_config(dir.string()), ConfigError) << text;
  }
  const NodeConfig config = load_config(kConfig);
  EXPECT_NEAR(config.mount.height_m, 1.1, 1e-9);
  EXPECT_NEAR(config.mount.pitch_down_rad, to_rad(17.0), 1e-9);
}

}  // namespace
}  // namespace rover::gaze
