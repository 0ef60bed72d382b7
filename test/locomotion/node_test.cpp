#include "locomotion/node.hpp"

#include <gtest/gtest.h>

#include <rover/drive_permit_t.hpp>
#include <rover/motion_command_t.hpp>
#include <rover/wheel_command_t.hpp>
#include <rover/wheel_state_t.hpp>

#include "test/trajectory_control/bus_world.hpp"

namespace rover::locomotion {
namespace {

class LocomotionNodeTest : public testing::Test {
 protected:
  LocomotionNodeTest() : node_({.name = "locomotion"}, world_.bus), service_(node_, load_config(config_dir_)) {
    commands_ = world_.listen<wheel_command_t>(channel::kWheelCommand);
    command_.mode = motion_command_t::ARC;
    command_.speed_mps = 0.1;
  }

  void tick() {
    if (permit_) {
      drive_permit_t permit{};
      permit.granted = 1;
      permit.max_speed_mps = 0.2;
      permit.valid_until_utime = world_.now + to_utime(0.2);
      world_.send(channel::kDrivePermit, permit);
    }
    command_.valid_until_utime = world_.now + to_utime(0.2);
    world_.send(channel::kMotionCommand, command_);
    world_.send(channel::kWheelState, wheel_state_);
    world_.tick(node_);
  }
  void run(double seconds) {
    for (Utime end = world_.now + to_utime(seconds); world_.now < end;) tick();
  }

  const std::string config_dir_ = ROVER_SOURCE_DIR "/config";
  test::BusWorld world_;
  Node node_;
  LocomotionNode service_;
  std::shared_ptr<std::vector<wheel_command_t>> commands_;
  motion_command_t command_{};
  wheel_state_t wheel_state_{};
  bool permit_ = true;
};

TEST_F(LocomotionNodeTest, PublishesEachTickWithValidUntil) {
  run(3.0);
  ASSERT_GE(commands_->size(), 149u);
  const wheel_command_t& last = commands_->back();
  EXPECT_EQ(last.valid_until_utime - last.header.utime, 200'000);
  EXPECT_NEAR(last.drive_rate_radps[0], 0.1 / 0.125, 1e-9);
}

TEST_F(LocomotionNodeTest, NoMotionWithoutPermit) {
  permit_ = false;
  run(2.0);
  ASSERT_FALSE(commands_->empty());
  for (const wheel_command_t& c : *commands_) EXPECT_EQ(c.drive_rate_radps[0], 0.0);
}

TEST_F(LocomotionNodeTest, UnknownModeStops) {
  run(3.0);
  command_.mode = 77;
  run(3.0);
  EXPECT_EQ(commands_->back().drive_rate_radps[0], 0.0);
}

TEST_F(LocomotionNodeTest, UnknownWheelStatusIsAFault) {
  run(3.0);
  wheel_state_.status = 9;
  run(1.0);
  EXPECT_EQ(commands_->back().drive_rate_radps[0], 0.0);
  EXPECT_LE(commands_->back().valid_until_utime, commands_->back().header.utime);
}

}  // namespace
}  // namespace rover::locomotion
