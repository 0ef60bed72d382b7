// The planner on an in-process bus: commands are answered, unusable input is counted, paths are published.
#include "path_planner/node.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <rover/command_ack_t.hpp>
#include <rover/fault_t.hpp>
#include <rover/hazards_t.hpp>
#include <rover/heartbeat_t.hpp>
#include <rover/planner_status_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/service_state_t.hpp>
#include <rover/supervisor_state_t.hpp>
#include <rover/traversability_t.hpp>
#include <set>

#include "common/bus/convert.hpp"
#include "path_planner/config.hpp"
#include "test/path_planner/rock_world.hpp"
#include "test/trajectory_control/bus_world.hpp"

namespace rover::planning {
namespace {

using testing_support::CameraModel;
using testing_support::observe;
using testing_support::Rock;

path_t ahead() {
  path_t out{};
  out.path_id = 5;
  out.frame = path_t::MAP;
  out.corridor_half_width_m = 0.75;
  out.goal_tolerance_m = 0.5;
  out.x_m = {0.0, 20.0};
  out.y_m = {0.0, 0.0};
  out.level = {path_t::EFFICIENT, path_t::EFFICIENT};
  out.direction = {path_t::FORWARD, path_t::FORWARD};
  out.point_count = 2;
  return out;
}

pose_t pose_at(const Pose2& pose) {
  pose_t out{};
  pose_to(from_planar(pose), out.position_odom_body_m, out.quat_odom_body_wxyz);
  pose_to(from_planar({0.0, 0.0, 0.0}), out.position_map_odom_m, out.quat_map_odom_wxyz);
  return out;
}

hazards_t frame_of(const std::vector<Rock>& rocks) {
  std::mt19937_64 random(1);
  const HazardGrid grid = observe(CameraModel{}, rocks, {0.0, 0.0, 0.0}, 0, random);
  hazards_t out{};
  out.cell_m = grid.cell_m;
  out.origin_x_m = grid.origin_x_m;
  out.origin_y_m = grid.origin_y_m;
  out.cells_x = static_cast<std::int16_t>(grid.cells_x);
  out.cells_y = static_cast<std::int16_t>(grid.cells_y);
  out.cells = grid.cells;
  out.size = static_cast<std::int32_t>(out.cells.size());
  return out;
}

class PlannerNodeTest : public testing::Test {
 protected:
  explicit PlannerNodeTest(const std::string& run_dir = "")
      : node_({.name = "path_planner", .run_dir = run_dir}, world_.bus),
        service_(node_, load_config(ROVER_SOURCE_DIR "/config")) {
    acks_ = world_.listen<command_ack_t>(channel::kCommandAck);
    paths_ = world_.listen<path_t>(channel::kPath);
    statuses_ = world_.listen<planner_status_t>(channel::kPlannerStatus);
    heartbeats_ = world_.listen<heartbeat_t>(channel::kHeartbeat);
  }

  void tick(int times = 1) {
    for (int i = 0; i < times; ++i) {
      if (posed_) world_.send(channel::kPose, pose_);
      world_.tick(node_);
      while (world_.bus.handleTimeout(0) > 0) {
      }
    }
  }

  void certify_start(double sigma_m = 0.1) {
    ground_command_t command{};
    command.kind = ground_command_t::SET_START_POSE;
    command.sigma_m = sigma_m;
    command.sigma_yaw_rad = 0.01;
    command.clear_radius_m = 2.0;
    world_.send(channel::kGroundCommand, command, "mission_control");
    tick(3);
  }

  // A frame of 40 ms ago, so that the pose of its exposure is known.
  void send_frame(const std::vector<Rock>& rocks) {
    hazards_t message = frame_of(rocks);
    message.header = detector_.next(channel::kHazards, world_.now - 2 * kTickUs, world_.now + kTickUs);
    world_.bus.publish(channel::kHazards, &message);
  }

  std::int64_t malformed(const std::string& channel) const {
    if (heartbeats_->empty()) return -1;
    for (const input_health_t& input : heartbeats_->back().inputs)
      if (input.channel == channel) return input.malformed;
    return -1;
  }

  test::BusWorld world_;
  StreamCounter detector_{"hazard_detector", 2};
  Node node_;
  PathPlannerNode service_;
  std::shared_ptr<std::vector<command_ack_t>> acks_;
  std::shared_ptr<std::vector<path_t>> paths_;
  std::shared_ptr<std::vector<planner_status_t>> statuses_;
  std::shared_ptr<std::vector<heartbeat_t>> heartbeats_;
  pose_t pose_ = pose_at({0.0, 0.0, 0.0});
  bool posed_ = true;
};

TEST_F(PlannerNodeTest, AGlobalPathIsAcknowledgedAndPublishedInOdom) {
  certify_start();
  world_.send(channel::kGlobalPath, ahead(), "mission_control");
  tick(3);
  ASSERT_EQ(acks_->size(), 1u);
  EXPECT_EQ(acks_->back().command_id, 5);
  EXPECT_EQ(acks_->back().accepted, 1);
  EXPECT_EQ(acks_->back().reason, "");
  ASSERT_EQ(paths_->size(), 1u);
  const path_t& path = paths_->back();
  EXPECT_EQ(path.frame, +path_t::ODOM);
  EXPECT_EQ(path.kind, +path_t::GLOBAL);
  EXPECT_EQ(path.corridor_half_width_m, 0.75);
  EXPECT_EQ(path.goal_tolerance_m, 0.5);
  ASSERT_GE(path.point_count, 2);
  EXPECT_EQ(path.x_m.size(), static_cast<size_t>(path.point_count));
  EXPECT_NEAR(path.x_m.back(), 20.0, 1e-6);
  EXPECT_EQ(statuses_->back().path_id, path.path_id);
  EXPECT_EQ(statuses_->back().global_path_id, 5);
}

TEST_F(PlannerNodeTest, APathIsReleasedAfterItsLatency) {
  certify_start();
  world_.send(channel::kGlobalPath, ahead(), "mission_control");
  tick(3);
  ASSERT_EQ(paths_->size(), 1u);
  EXPECT_GE(paths_->back().header.release_utime - paths_->back().header.utime, 100'000);
}

TEST_F(PlannerNodeTest, InvalidGlobalPathsAreRefusedWithAReasonAndTheOldOneStays) {
  certify_start();
  world_.send(channel::kGlobalPath, ahead(), "mission_control");
  std::vector<path_t> bad(6, ahead());
  bad[0].x_m[1] = kNaN;
  bad[1].x_m = {1.0};
  bad[1].y_m = {1.0};
  bad[1].level = {0};
  bad[1].point_count = 1;
  bad[2].frame = path_t::ODOM;
  bad[3].level[1] = 9;
  bad[4].goal_tolerance_m = -1.0;
  bad[5].x_m = bad[5].y_m = {};
  bad[5].level = {};
  bad[5].point_count = 0;
  for (size_t i = 0; i < bad.size(); ++i) {
    bad[i].path_id = 10 + static_cast<std::int64_t>(i);
    world_.send(channel::kGlobalPath, bad[i], "mission_control");
  }
  tick(12);
  ASSERT_EQ(acks_->size(), 1 + bad.size());
  for (size_t i = 0; i < bad.size(); ++i) {
    const command_ack_t& ack = (*acks_)[i + 1];
    EXPECT_EQ(ack.command_id, 10 + static_cast<std::int64_t>(i));
    EXPECT_EQ(ack.accepted, 0) << i;
    EXPECT_NE(ack.reason, "") << i;
  }
  EXPECT_EQ(malformed(channel::kGlobalPath), 6);
  EXPECT_EQ(statuses_->back().global_path_id, 5);
  EXPECT_EQ(statuses_->back().state, +planner_status_t::FOLLOWING);
}

TEST_F(PlannerNodeTest, ARockOnThePathMakesARepair) {
  certify_start();
  world_.send(channel::kGlobalPath, ahead(), "mission_control");
  tick(3);
  for (int i = 0; i < 6; ++i) {
    send_frame({{{3.0, 0.1}, 0.25, 0.3}});
    tick(10);
  }
  ASSERT_GE(paths_->size(), 2u);
  EXPECT_EQ(paths_->back().kind, +path_t::REPAIR);
  EXPECT_EQ(statuses_->back().state, +planner_status_t::REPAIRING);
  EXPECT_GE(statuses_->back().replans, 1);
  EXPECT_GT(paths_->back().path_id, paths_->front().path_id);
}

// Answered by a new path, and by another one if that has not ended the fault.
TEST_F(PlannerNodeTest, APersistentFaultAsksForAPathAgain) {
  certify_start();
  world_.send(channel::kGlobalPath, ahead(), "mission_control");
  tick(3);
  fault_t fault{};
  fault.response = fault_t::STOP_REPLAN;
  fault.active = 1;
  fault.visible_utime = world_.now;
  const auto seconds_with_fault = [&](int seconds) {
    for (int i = 0; i < 5 * seconds; ++i) {
      if (i % 5 == 0) world_.send(channel::kFault, fault, "supervisor");
      send_frame({});
      tick(10);
    }
    std::set<std::int64_t> ids;
    for (const path_t& path : *paths_) ids.insert(path.path_id);
    return ids.size();
  };
  EXPECT_EQ(seconds_with_fault(4), 2u);
  EXPECT_EQ(seconds_with_fault(4), 3u);
}

// Backing up is for a fault that stops the rover for long, not for one that ends by itself.
TEST_F(PlannerNodeTest, AFaultThatStopsTheRoverForLongMakesItBackUp) {
  certify_start();
  world_.send(channel::kGlobalPath, ahead(), "mission_control");
  for (double x_m = 0.0; x_m < 2.0; x_m += 0.05) {
    pose_ = pose_at({x_m, 0.0, 0.0});
    send_frame({});
    tick(5);
  }
  fault_t fault{};
  fault.response = fault_t::STOP_BACKTRACK;
  fault.active = 1;
  fault.visible_utime = world_.now;
  supervisor_state_t state{};
  const auto kind_after = [&](int seconds, std::int8_t rover_state) {
    for (int i = 0; i < 5 * seconds; ++i) {
      state.state = rover_state;
      world_.send(channel::kState, state, "supervisor");
      if (i % 5 == 0) world_.send(channel::kFault, fault, "supervisor");
      send_frame({});
      tick(10);
    }
    return paths_->back().kind;
  };
  EXPECT_EQ(kind_after(15, supervisor_state_t::TELEOP), +path_t::GLOBAL);
  EXPECT_EQ(kind_after(9, supervisor_state_t::FAULT_STOP), +path_t::GLOBAL)
      << "raised long ago, but the rover has just stopped";
  fault.visible_utime = world_.now;
  EXPECT_EQ(kind_after(9, supervisor_state_t::PAUSED), +path_t::GLOBAL) << "raised again";
  EXPECT_EQ(kind_after(3, supervisor_state_t::PAUSED), +path_t::BACKTRACK);
}

TEST_F(PlannerNodeTest, UnusableMessagesAreCountedAndChangeNothing) {
  certify_start();
  world_.send(channel::kGlobalPath, ahead(), "mission_control");
  tick(3);
  std::vector<hazards_t> bad(5, frame_of({}));
  bad[0].cells_x = 0;
  bad[1].cells_y = static_cast<std::int16_t>(bad[1].cells_y + 1);
  bad[2].cell_m = kNaN;
  bad[3].origin_x_m = kInfinity;
  bad[4].cells[3] = 77;
  for (const hazards_t& message : bad) world_.send(channel::kHazards, message, "hazard_detector");
  ground_command_t start{};
  start.kind = ground_command_t::SET_START_POSE;
  start.position_map_m[0] = kNaN;
  world_.send(channel::kGroundCommand, start, "mission_control");
  start.position_map_m[0] = 0.0;
  start.clear_radius_m = 100.0;
  world_.send(channel::kGroundCommand, start, "mission_control");
  const std::uint8_t foreign[] = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  world_.bus.publish(channel::kHazards, foreign, sizeof(foreign));
  tick(12);
  EXPECT_EQ(malformed(channel::kHazards), 6);
  EXPECT_EQ(malformed(channel::kGroundCommand), 2);
  EXPECT_EQ(paths_->size(), 1u);
  EXPECT_EQ(statuses_->back().state, +planner_status_t::FOLLOWING);
}

traversability_t free_map() {
  traversability_t out{};
  out.cell_m = 0.1;
  out.origin_x_m = out.origin_y_m = -10.0;
  out.cells_x = out.cells_y = 200;
  out.cells.assign(40000, 0);
  out.step_percent.assign(40000, 0);
  out.height_m.assign(40000, 0.0F);
  out.size = 40000;
  return out;
}

// A map must be older than the tick that takes it.
TEST_F(PlannerNodeTest, AtTheFullLevelAMapMakesAContinuousPath) {
  certify_start();
  world_.send(channel::kGlobalPath, ahead(), "mission_control");
  tick(3);
  world_.send(channel::kTraversability, free_map(), "traversability");
  tick(5);
  EXPECT_EQ(paths_->back().kind, +path_t::GLOBAL) << "the Efficient level uses no map";
  supervisor_state_t state{};
  state.level = supervisor_state_t::FULL;
  world_.send(channel::kState, state, "supervisor");
  tick(3);
  world_.send(channel::kTraversability, free_map(), "traversability");
  tick(20);
  EXPECT_EQ(paths_->back().kind, +path_t::CONTINUOUS);
  EXPECT_EQ(malformed(channel::kTraversability), 0);
  EXPECT_EQ(statuses_->back().replans, 0);
}

TEST_F(PlannerNodeTest, UnusableMapsAndLevelsAreCountedAndChangeNothing) {
  certify_start();
  world_.send(channel::kGlobalPath, ahead(), "mission_control");
  supervisor_state_t state{};
  state.level = supervisor_state_t::FULL;
  world_.send(channel::kState, state, "supervisor");
  tick(3);
  std::vector<traversability_t> bad(4, free_map());
  bad[0].cells_x = 0;
  bad[1].cells_y = 201;
  bad[2].cell_m = kNaN;
  bad[3].origin_y_m = kNaN;
  for (const traversability_t& message : bad) world_.send(channel::kTraversability, message, "traversability");
  const auto send_measured = [&](Utime utime, std::int64_t boot) {
    StreamCounter maps("traversability", boot);
    traversability_t message = free_map();
    message.header = maps.next(channel::kTraversability, utime, world_.now + kTickUs);
    world_.bus.publish(channel::kTraversability, &message);
  };
  send_measured(world_.now + to_utime(5.0), 3);  // of the future
  tick(12);
  EXPECT_GE(malformed(channel::kTraversability), 5);
  EXPECT_EQ(paths_->back().kind, +path_t::GLOBAL);
  tick(400);
  send_measured(world_.now - to_utime(6.0), 4);  // too old
  tick(60);
  EXPECT_GE(malformed(channel::kTraversability), 6);
  EXPECT_EQ(paths_->back().kind, +path_t::GLOBAL);
  state.level = 7;
  world_.send(channel::kState, state, "supervisor");
  tick(60);
  EXPECT_EQ(malformed(channel::kState), 1);
}

TEST_F(PlannerNodeTest, PoseStatusAndAgeDecide) {
  certify_start();
  world_.send(channel::kGlobalPath, ahead(), "mission_control");
  tick(3);
  pose_.status = pose_t::DEGRADED;
  tick();
  EXPECT_EQ(statuses_->back().state, +planner_status_t::FOLLOWING);
  for (const std::int8_t status : {pose_t::LOST, static_cast<std::int8_t>(99)}) {
    pose_.status = status;
    tick();
    EXPECT_EQ(statuses_->back().state, +planner_status_t::IDLE) << int(status);
    EXPECT_EQ(statuses_->back().path_id, -1);
  }
  pose_.status = pose_t::OK;
  pose_.velocity_body_mps[0] = kNaN;
  tick();
  EXPECT_EQ(statuses_->back().state, +planner_status_t::IDLE);
  pose_.velocity_body_mps[0] = 0.0;
  tick();
  EXPECT_EQ(statuses_->back().state, +planner_status_t::FOLLOWING);
  posed_ = false;
  tick(30);
  EXPECT_EQ(statuses_->back().state, +planner_status_t::IDLE);
  EXPECT_EQ(statuses_->back().text, "no fresh pose");
}

// Localization that begins anew has another odom: what is known there lies elsewhere.
TEST_F(PlannerNodeTest, ANewOdomEndsWhatIsKnown) {
  certify_start();
  world_.send(channel::kGlobalPath, ahead(), "mission_control");
  tick(3);
  ASSERT_GT(statuses_->back().blocked_in_m, 0.5);
  pose_.status = pose_t::UNINITIALISED;
  tick();
  EXPECT_EQ(statuses_->back().state, +planner_status_t::IDLE);
  pose_.status = pose_t::OK;
  tick(3);
  EXPECT_LT(statuses_->back().blocked_in_m, 0.3) << "the ground ahead is not known";
  certify_start();
  EXPECT_GT(statuses_->back().blocked_in_m, 0.5);
}

TEST_F(PlannerNodeTest, AStartPoseThatLocalizationRefusesCertifiesNothing) {
  certify_start(0.0);
  world_.send(channel::kGlobalPath, ahead(), "mission_control");
  tick(50);
  EXPECT_EQ(malformed(channel::kGroundCommand), 1);
  EXPECT_LT(statuses_->back().blocked_in_m, 0.3);
}

TEST_F(PlannerNodeTest, AStatusIsPublishedEachTick) {
  tick(10);
  EXPECT_EQ(statuses_->size(), 10u);
  EXPECT_EQ(statuses_->back().state, +planner_status_t::IDLE);
}

// A restarted controller has no path.
TEST_F(PlannerNodeTest, ThePathIsRepeatedEachSecondUnchanged) {
  certify_start();
  world_.send(channel::kGlobalPath, ahead(), "mission_control");
  tick(160);
  EXPECT_GE(paths_->size(), 3u);
  EXPECT_LE(paths_->size(), 5u);
  for (const path_t& path : *paths_) {
    EXPECT_EQ(path.path_id, paths_->front().path_id);
    EXPECT_EQ(path.x_m, paths_->front().x_m);
  }
}

std::string fresh_folder() {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "path_planner_node";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder.string();
}

class PlannerRestartTest : public PlannerNodeTest {
 protected:
  PlannerRestartTest() : PlannerNodeTest(fresh_folder()) {}
};

TEST_F(PlannerRestartTest, ARestartedNodeReportsItsStateAndPublishesItsPathAgain) {
  certify_start();
  world_.send(channel::kGlobalPath, ahead(), "mission_control");
  tick(60);  // a checkpoint each second
  ASSERT_FALSE(paths_->empty());
  test::BusWorld world;
  world.now = world_.now;
  Node node({.name = "path_planner", .boot_id = 2, .run_dir = node_.options().run_dir}, world.bus);
  const PathPlannerNode restarted(node, load_config(ROVER_SOURCE_DIR "/config"));
  const auto paths = world.listen<path_t>(channel::kPath);
  const auto states = world.listen<service_state_t>(channel::kServiceState);
  for (int i = 0; i < 3; ++i) {
    world.send(channel::kPose, pose_);
    world.tick(node);
    while (world.bus.handleTimeout(0) > 0) {
    }
  }
  ASSERT_EQ(states->size(), 1u);
  EXPECT_EQ(states->back().service, "path_planner");
  EXPECT_GT(states->back().size, 0);
  ASSERT_EQ(paths->size(), 1u);
  EXPECT_GT(paths->back().path_id, paths_->back().path_id);
  EXPECT_EQ(paths->back().x_m, paths_->back().x_m);
  EXPECT_EQ(paths->back().y_m, paths_->back().y_m);
}

}  // namespace
}  // namespace rover::planning
