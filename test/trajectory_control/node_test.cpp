#include "trajectory_control/node.hpp"

#include <gtest/gtest.h>

#include <rover/control_status_t.hpp>
#include <rover/drive_permit_t.hpp>
#include <rover/motion_command_t.hpp>
#include <rover/path_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/supervisor_state_t.hpp>

#include "common/bus/convert.hpp"
#include "test/trajectory_control/bus_world.hpp"
#include "trajectory_control/config.hpp"

namespace rover::control {
namespace {

class ControlNodeTest : public testing::Test {
 protected:
  ControlNodeTest()
      : node_({.name = "trajectory_control"}, world_.bus), service_(node_, load_config(ROVER_SOURCE_DIR "/config")) {
    commands_ = world_.listen<motion_command_t>(channel::kMotionCommand);
    statuses_ = world_.listen<control_status_t>(channel::kControlStatus);
    pose_to(from_planar({1.0, 0.0, 0.0}), pose_.position_odom_body_m, pose_.quat_odom_body_wxyz);
  }

  static path_t path() {
    path_t out{};
    out.path_id = 5;
    out.frame = path_t::ODOM;
    out.corridor_half_width_m = 0.75;
    out.x_m = {0.0, 10.0};
    out.y_m = {0.0, 0.0};
    out.level = {0, 0};
    out.direction = {0, 0};
    out.point_count = 2;
    return out;
  }

  void tick() {
    drive_permit_t permit{};
    permit.granted = 1;
    permit.max_speed_mps = 0.2;
    permit.valid_until_utime = world_.now + to_utime(0.2);
    world_.send(channel::kDrivePermit, permit);
    world_.send(channel::kPose, pose_);
    world_.tick(node_);
    world_.bus.handleTimeout(0);
  }

  test::BusWorld world_;
  Node node_;
  TrajectoryControlNode service_;
  std::shared_ptr<std::vector<motion_command_t>> commands_;
  std::shared_ptr<std::vector<control_status_t>> statuses_;
  pose_t pose_{};
};

TEST_F(ControlNodeTest, FollowsAPathAndReportsEachTick) {
  world_.send(channel::kPath, path());
  for (int i = 0; i < 5; ++i) tick();
  ASSERT_EQ(commands_->size(), 5u);
  ASSERT_EQ(statuses_->size(), 5u);
  EXPECT_EQ(statuses_->back().state, +control_status_t::FOLLOWING);
  EXPECT_EQ(statuses_->back().path_id, 5);
  EXPECT_NEAR(statuses_->back().arc_length_m, 1.0, 1e-6);
  EXPECT_EQ(commands_->back().mode, +motion_command_t::ARC);
  EXPECT_EQ(commands_->back().valid_until_utime - commands_->back().header.utime, 200'000);
}

TEST_F(ControlNodeTest, PathInMapFrameOrWithNanIsRejected) {
  path_t in_map = path();
  in_map.frame = path_t::MAP;
  world_.send(channel::kPath, in_map);
  tick();
  tick();
  EXPECT_EQ(statuses_->back().state, +control_status_t::IDLE);
  world_.send(channel::kPath, path());
  tick();
  EXPECT_EQ(statuses_->back().state, +control_status_t::FOLLOWING);
  path_t broken = path();
  broken.x_m[1] = kNaN;
  world_.send(channel::kPath, broken);
  tick();
  EXPECT_EQ(statuses_->back().state, +control_status_t::IDLE);
  EXPECT_EQ(commands_->back().mode, +motion_command_t::STOP);
}

TEST_F(ControlNodeTest, TeleoperationBesideThePathDoesNotBiasTheSteeringAfterwards) {
  supervisor_state_t state{};
  const auto drive = [&](int ticks, std::int8_t in_state, double forward_mps) {
    state.state = in_state;
    world_.send(channel::kState, state);
    pose_.velocity_body_mps[0] = forward_mps;
    for (int i = 0; i < ticks; ++i) tick();
    return commands_->back().curvature_per_m;
  };
  pose_to(from_planar({1.0, 0.1, 0.0}), pose_.position_odom_body_m, pose_.quat_odom_body_wxyz);
  world_.send(channel::kPath, path());
  const double before_per_m = drive(1, supervisor_state_t::DRIVING, 0.0);
  ASSERT_EQ(commands_->back().mode, +motion_command_t::ARC);
  drive(500, supervisor_state_t::TELEOP, 0.2);
  EXPECT_EQ(drive(1, supervisor_state_t::DRIVING, 0.0), before_per_m);
  drive(500, supervisor_state_t::DRIVING, 0.2);
  EXPECT_LT(drive(1, supervisor_state_t::DRIVING, 0.0), before_per_m);
}

TEST_F(ControlNodeTest, OnlyPoseStatusOkAndDegradedAreUsed) {
  world_.send(channel::kPath, path());
  const std::vector<std::pair<int, int>> expected = {{pose_t::OK, control_status_t::FOLLOWING},
                                                     {pose_t::DEGRADED, control_status_t::FOLLOWING},
                                                     {pose_t::LOST, control_status_t::STALE_POSE},
                                                     {pose_t::UNINITIALISED, control_status_t::STALE_POSE},
                                                     {99, control_status_t::STALE_POSE}};
  for (const auto& [status, state] : expected) {
    pose_.status = static_cast<std::int8_t>(status);
    tick();
    EXPECT_EQ(statuses_->back().state, state) << status;
  }
}

}  // namespace
}  // namespace rover::control
