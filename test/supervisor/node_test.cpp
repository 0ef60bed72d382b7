#include "supervisor/node.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <rover/command_ack_t.hpp>
#include <rover/control_status_t.hpp>
#include <rover/drive_permit_t.hpp>
#include <rover/ground_command_t.hpp>
#include <rover/hazards_t.hpp>
#include <rover/imu_t.hpp>
#include <rover/motion_command_t.hpp>
#include <rover/planner_status_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/supervisor_state_t.hpp>
#include <rover/wheel_state_t.hpp>

#include "common/bus/checkpoint.hpp"
#include "common/bus/convert.hpp"
#include "supervisor/config.hpp"
#include "supervisor/convert.hpp"
#include "supervisor/persistent_state_codec.hpp"
#include "test/trajectory_control/bus_world.hpp"

namespace rover::supervisor {
namespace {

class SupervisorNodeTest : public testing::Test {
 protected:
  SupervisorNodeTest()
      : node_({.name = "supervisor"}, world_.bus),
        service_(node_, config_, [this](const std::string& service, const char* option) {
          controlled_.push_back(service + option);
          return true;
        }) {
    permits_ = world_.listen<drive_permit_t>(channel::kDrivePermit);
    states_ = world_.listen<supervisor_state_t>(channel::kState);
    acks_ = world_.listen<command_ack_t>(channel::kCommandAck);
    pose_to(Eigen::Isometry3d::Identity(), pose_.position_odom_body_m, pose_.quat_odom_body_wxyz);
    pose_to(Eigen::Isometry3d::Identity(), pose_.position_map_odom_m, pose_.quat_map_odom_wxyz);
    planner_.path_id = 3;
    planner_.state = planner_status_t::FOLLOWING;
    planner_.blocked_in_m = kInfinity;
    planner_.goal_distance_m = 10.0;
    control_.path_id = 3;
    control_.state = control_status_t::FOLLOWING;
    hazards_.coverage = 0.9f;
  }

  void tick() {
    world_.send(channel::kPose, pose_);
    world_.send(channel::kPlannerStatus, planner_);
    world_.send(channel::kControlStatus, control_);
    world_.send(channel::kHazards, hazards_);
    world_.send(channel::kWheelState, wheel_state_t{});
    world_.send(channel::kImu, imu_t{});
    world_.send(channel::kMotionCommand, motion_command_t{});
    heartbeat_t beat{};
    beat.pid = std::numeric_limits<int>::max();  // no such process
    for (const std::string& service : config_.fdir.required_services)
      if (service != silent_) world_.send(channel::kHeartbeat, beat, service);
    world_.tick(node_);
    world_.bus.handleTimeout(0);
  }
  void command(std::int8_t kind, std::int64_t id) {
    ground_command_t message{};
    message.kind = kind;
    message.command_id = id;
    world_.send(channel::kGroundCommand, message);
    tick();
  }

  SupervisorConfig config_ = load_config(ROVER_SOURCE_DIR "/config");
  test::BusWorld world_;
  std::vector<std::string> controlled_;  // service and option
  std::string silent_;
  Node node_;
  SupervisorNode service_;
  std::shared_ptr<std::vector<drive_permit_t>> permits_;
  std::shared_ptr<std::vector<supervisor_state_t>> states_;
  std::shared_ptr<std::vector<command_ack_t>> acks_;
  pose_t pose_{};
  planner_status_t planner_{};
  control_status_t control_{};
  hazards_t hazards_{};
};

TEST_F(SupervisorNodeTest, GrantsPermitAfterGoAndPublishesStates) {
  for (int i = 0; i < 10; ++i) tick();
  ASSERT_EQ(permits_->size(), 10u);
  EXPECT_EQ(permits_->back().granted, 0);
  EXPECT_LE(permits_->back().valid_until_utime, permits_->back().header.utime);
  EXPECT_EQ(permits_->back().reason, "STANDBY");
  command(ground_command_t::GO, 12);
  ASSERT_EQ(acks_->size(), 1u);
  EXPECT_EQ(acks_->back().command_id, 12);
  EXPECT_EQ(acks_->back().accepted, 1);
  EXPECT_EQ(permits_->back().granted, 1);
  EXPECT_EQ(permits_->back().valid_until_utime - permits_->back().header.utime, 200'000);
  ASSERT_FALSE(states_->empty());
  EXPECT_EQ(states_->back().state, +supervisor_state_t::DRIVING);
  EXPECT_EQ(states_->back().cause, "go");
  const size_t before = states_->size();
  for (int i = 0; i < 50; ++i) tick();
  EXPECT_NEAR(static_cast<double>(states_->size() - before), 10.0, 1.0);
}

TEST_F(SupervisorNodeTest, NanInThePoseStopsTheRover) {
  for (int i = 0; i < 10; ++i) tick();
  command(ground_command_t::GO, 1);
  for (double* field : {&pose_.position_odom_body_m[1], &pose_.quat_map_odom_wxyz[2], &pose_.velocity_body_mps[0],
                        &pose_.rate_body_radps[2]}) {
    const double good = *field;
    EXPECT_TRUE(report_from(pose_, 0.62).usable);
    *field = kNaN;
    EXPECT_FALSE(report_from(pose_, 0.62).usable);
    *field = good;
  }
  pose_.velocity_body_mps[0] = kNaN;
  tick();
  EXPECT_EQ(permits_->back().granted, 0);
  EXPECT_EQ(states_->back().state, +supervisor_state_t::FAULT_STOP);
  EXPECT_EQ(states_->back().faults, std::vector<std::string>{"pose_status"});
}

// A crashed process is started again by s6; if that one sends no heartbeat either, it hangs.
TEST_F(SupervisorNodeTest, KillsAServiceThatHangsBeforeItsFirstHeartbeat) {
  for (int i = 0; i < 10; ++i) tick();
  controlled_.clear();
  silent_ = "stereo";
  for (int i = 0; i < 100; ++i) tick();
  EXPECT_EQ(controlled_, std::vector<std::string>{});
  for (int i = 0; i < 250; ++i) tick();
  EXPECT_EQ(controlled_, std::vector<std::string>{"stereo-k"});
}

TEST_F(SupervisorNodeTest, DoesNotAnswerSetStartPose) {
  tick();
  command(ground_command_t::SET_START_POSE, 5);
  EXPECT_TRUE(acks_->empty());
}

TEST_F(SupervisorNodeTest, RefusesUnknownCommandsWithAReason) {
  tick();
  command(77, 5);
  ASSERT_EQ(acks_->size(), 1u);
  EXPECT_EQ(acks_->back().accepted, 0);
  EXPECT_FALSE(acks_->back().reason.empty());
}

TEST(Convert, UnknownStatusCountsAsBad) {
  hazards_t hazards{};
  hazards.state = 17;
  EXPECT_TRUE(report_from(hazards).blind);
  hazards.state = hazards_t::CLEAR;
  EXPECT_FALSE(report_from(hazards).blind);
  pose_t pose{};
  pose.status = pose_t::UNINITIALISED;
  EXPECT_FALSE(report_from(pose, 0.62).usable);
}

// A supervisor without inputs, with a run folder.
class SupervisorCheckpointTest : public testing::Test {
 protected:
  SupervisorCheckpointTest() {
    std::filesystem::remove_all(dir_);
    std::filesystem::create_directories(dir_);
  }
  ~SupervisorCheckpointTest() override { std::filesystem::remove_all(dir_); }

  void start() {
    node_ = std::make_unique<Node>(NodeOptions{.name = "supervisor", .run_dir = dir_}, world_.bus);
    service_ = std::make_unique<SupervisorNode>(*node_, load_config(ROVER_SOURCE_DIR "/config"),
                                                [](const std::string&, const char*) { return false; });
  }
  void run(double seconds) {
    for (const Utime end = world_.now + to_utime(seconds); world_.now < end;) {
      if (wheels_) world_.send(channel::kWheelState, *wheels_);
      world_.tick(*node_);
    }
  }
  std::optional<PersistentState> saved() const {
    const auto bytes = load_checkpoint(dir_, "supervisor");
    return bytes ? persistent_state_from(*bytes) : std::nullopt;
  }

  const std::string dir_ = testing::TempDir() + "/supervisor_checkpoint_test";
  test::BusWorld world_;
  std::optional<wheel_state_t> wheels_;
  std::unique_ptr<Node> node_;
  std::unique_ptr<SupervisorNode> service_;
};

TEST_F(SupervisorCheckpointTest, MotorHeatIsSavedEachSecond) {
  wheels_ = wheel_state_t{};
  wheels_->drive_current_a[2] = 4.0;
  start();
  run(3.5);
  const auto state = saved();
  ASSERT_TRUE(state);
  EXPECT_GE(state->heat.utime, world_.now - 1'100'000);
  EXPECT_LE(state->heat.utime, world_.now);
  EXPECT_NEAR(state->heat.drive_i2t_load[2], 0.064, 0.02);  // after 2.5 to 3.5 s at 4 A
}

TEST_F(SupervisorCheckpointTest, TimeIsSavedEachSecondAlsoWithoutInputs) {
  start();
  run(3.5);
  const auto state = saved();
  ASSERT_TRUE(state);
  EXPECT_GE(state->utime, world_.now - 1'100'000);
}

TEST_F(SupervisorCheckpointTest, FreshRunBootsAndAnOldOrDamagedFileIsSafe) {
  const auto states = world_.listen<supervisor_state_t>(channel::kState);
  start();
  run(0.2);
  ASSERT_FALSE(states->empty());
  EXPECT_EQ(states->back().state, +supervisor_state_t::BOOT);
  world_.now += to_utime(20.0);
  start();
  run(0.2);
  EXPECT_EQ(states->back().state, +supervisor_state_t::SAFE);
  EXPECT_EQ(states->back().cause, "checkpoint_old");
  EXPECT_EQ(saved()->state, State::kSafe);
  std::filesystem::resize_file(dir_ + "/supervisor.ckpt", 5);
  testing::internal::CaptureStdout();
  start();
  run(0.2);
  EXPECT_NE(testing::internal::GetCapturedStdout().find("CHECKPOINT unusable"), std::string::npos);
  EXPECT_EQ(states->back().state, +supervisor_state_t::SAFE);
  EXPECT_EQ(states->back().cause, "checkpoint_unusable");
}

TEST_F(SupervisorCheckpointTest, FullDiskIsTriedOnceASecondAndForgottenAfterwards) {
  const auto beats = world_.listen<heartbeat_t>(channel::kHeartbeat);
  std::filesystem::create_directories(dir_ + "/supervisor.ckpt.new");  // instead of the file
  start();
  ground_command_t stop{};
  stop.kind = ground_command_t::EMERGENCY_STOP;
  world_.send(channel::kGroundCommand, stop);
  testing::internal::CaptureStdout();
  run(3.0);
  const std::string log = testing::internal::GetCapturedStdout();
  int warnings = 0;
  for (size_t at = log.find("not saved"); at != std::string::npos; at = log.find("not saved", at + 1)) ++warnings;
  EXPECT_EQ(warnings, 3);
  ASSERT_FALSE(beats->empty());
  EXPECT_EQ(beats->back().status, +heartbeat_t::DEGRADED);
  std::filesystem::remove(dir_ + "/supervisor.ckpt.new");
  run(1.5);
  EXPECT_EQ(beats->back().status, +heartbeat_t::OK);
  EXPECT_EQ(beats->back().text, "");
  ASSERT_TRUE(saved());
  EXPECT_EQ(saved()->state, State::kSafe);
}

TEST(PersistentStateCodec, AllOfItIsRestored) {
  PersistentState state;
  state.state = State::kPaused;
  state.level = Level::kFull;
  state.raised_by_path = state.path_full = true;
  state.forced = ForcedLevel::kFull;
  state.hazard_stops = 3;
  state.backtracking_path_id = 7;
  state.faults = {"roll", "starts.stereo"};
  state.counters = {{{"stereo", {1'000'000, 2'000'000}}}, {1.25, 3.5}};
  state.restart_attempts = {{"slam", {3'000'000}}};
  state.heat = {4'000'000, {0.1, 0.2, 0.3, 0.4, 0.5, 0.6}, {1.1, 1.2, 1.3, 1.4}};
  state.utime = 5'000'000;
  EXPECT_EQ(persistent_state_from(bytes_of(state)), state);
}

TEST(PersistentStateCodec, AnyNameOnTheBusCanBeSaved) {
  PersistentState state;
  state.counters.starts["\xff"] = {1'000'000};
  EXPECT_TRUE(persistent_state_from(bytes_of(state)));
}

TEST(PersistentStateCodec, OtherVersionsAndDamagedTextsAreRefused) {
  const std::vector<std::uint8_t> bytes = bytes_of({});
  const std::string text(bytes.begin(), bytes.end());
  const auto read = [](const std::string& json) { return persistent_state_from({json.begin(), json.end()}); };
  ASSERT_TRUE(read(text));
  const size_t version = text.find("\"version\":3");
  ASSERT_NE(version, std::string::npos);
  EXPECT_FALSE(read(std::string(text).replace(version, 11, "\"version\":2")));
  EXPECT_FALSE(read(R"({"state":2,"level":0,"raised_by_path":false,"forced":2,"hazard_stops":0,"faults":[]})"));
  EXPECT_FALSE(read(text.substr(0, text.size() / 2)));
}

}  // namespace
}  // namespace rover::supervisor
