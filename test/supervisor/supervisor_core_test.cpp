// Behaviour of the supervisor core for healthy, silent and faulty inputs, and for ground commands.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "supervisor/config.hpp"
#include "supervisor/supervisor.hpp"

namespace rover::supervisor {
namespace {

// Healthy streams at their rates; tests silence or modify single ones.
class SupervisorTest : public testing::Test {
 protected:
  void tick() {
    now_ += kTickUs;
    const Utime made = now_ - kTickUs;
    if (pose_alive_) {
      pose_.utime = pose_.vo_utime = made;
      pose_.usable = pose_usable_;
      pose_.speed_mps = pose_.forward_mps = speed_;
      pose_.turn_rate_radps = 0.0;
      supervisor_.on_pose(pose_);
    }
    if (wheels_alive_) {
      wheels_.utime = made;
      if (wheels_follow_) wheels_.drive_rate_radps.fill(out_.permit.granted ? 0.8 : 0.0);
      supervisor_.on_wheels(wheels_);
    }
    if (imu_alive_) supervisor_.on_imu({made, false});
    if (command_alive_) supervisor_.on_motion_command(made);
    if (planner_alive_) {
      planner_.utime = made;
      supervisor_.on_planner(planner_);
    }
    if (control_alive_) {
      control_.utime = made;
      supervisor_.on_control(control_);
    }
    if (hazards_alive_ && now_ % hazards_period_ == 0) supervisor_.on_hazards({now_ - 240'000, blind_, coverage_});
    if (now_ % 200'000 == 0) heartbeats(made);
    supervisor_.on_slip({made, slip_valid_, slip_});
    out_ = supervisor_.step(now_);
    for (const StateChange& change : out_.changes) changes_.push_back(change);
    for (const FaultChange& change : out_.faults) faults_.push_back(change);
    restarts_.insert(restarts_.end(), out_.restarts.begin(), out_.restarts.end());
    if (out_.run_full) run_full_.push_back(*out_.run_full);
    EXPECT_TRUE(!out_.permit.granted || supervisor_.state() == State::kDriving ||
                supervisor_.state() == State::kTeleop);
    EXPECT_TRUE(!out_.permit.granted || out_.permit.valid_until == now_ + 200'000);
    EXPECT_TRUE(out_.permit.granted || out_.permit.valid_until == now_);
  }
  void heartbeats(Utime made) {
    for (const std::string& service : config_.fdir.required_services) {
      if (service == dead_service_) continue;
      ServiceReport& report = services_[service];
      report.utime = made;
      report.boot_id = std::max<std::int64_t>(report.boot_id, 1);
      report.received += 100;
      supervisor_.on_service(service, report);
    }
  }
  void run(double seconds) {
    for (Utime end = now_ + to_utime(seconds); now_ < end;) tick();
  }
  CommandAnswer command(CommandKind kind, const std::string& target = "", ForcedLevel level = ForcedLevel::kAuto) {
    supervisor_.on_command({++command_id_, kind, target, level});
    tick();
    EXPECT_EQ(out_.answers.size(), 1u);
    EXPECT_EQ(out_.answers.at(0).id, command_id_);
    return out_.answers.at(0);
  }
  // `path`: repeated by the planner.
  void restart_supervisor(const std::optional<PathLevels>& path = PathLevels{1}) {
    PersistentState persistent_state = supervisor_.persistent_state();
    persistent_state.utime = now_;
    supervisor_ = Supervisor(config_);
    supervisor_.restore(persistent_state);
    if (path) supervisor_.on_path(*path);
    EXPECT_EQ(supervisor_.persistent_state().heat, persistent_state.heat);
    EXPECT_EQ(supervisor_.persistent_state().counters, persistent_state.counters);
    tick();
    EXPECT_FALSE(out_.permit.granted);
  }
  void restart_services(int times) {
    for (int i = 0; i < times; ++i) {
      ++services_["hazard_detector"].boot_id;
      services_["hazard_detector"].received = 0;
      run(2.0);
    }
  }
  void start_driving() {
    run(2.0);
    ASSERT_EQ(supervisor_.state(), State::kStandby);
    ASSERT_TRUE(command(CommandKind::kGo).accepted);
    run(2.0);
    ASSERT_EQ(supervisor_.state(), State::kDriving);
    ASSERT_TRUE(out_.permit.granted);
    ASSERT_TRUE(faults_.empty());
    changes_.clear();
  }
  // Seconds until the permit is withdrawn.
  double time_to_withdrawal(double limit_s = 30.0) {
    const Utime start = now_;
    while (out_.permit.granted && now_ - start < to_utime(limit_s)) tick();
    return to_seconds(now_ - start);
  }
  double time_to_permit(double limit_s = 30.0) {
    const Utime start = now_;
    while (!out_.permit.granted && now_ - start < to_utime(limit_s)) tick();
    return to_seconds(now_ - start);
  }

  static PlannerReport clear_path() {
    PlannerReport out;
    out.state = PlannerState::kFollowing;
    out.path_id = 1;
    out.blocked_in_m = kInfinity;
    out.goal_distance_m = 50.0;
    return out;
  }
  static ControlReport following() {
    ControlReport out;
    out.path_id = 1;
    out.cross_track_m = 0.02;
    out.corridor_half_width_m = 0.75;
    return out;
  }

  SupervisorConfig config_ = load_config(ROVER_SOURCE_DIR "/config");
  Supervisor supervisor_{config_};
  SupervisorOutput out_;
  std::vector<StateChange> changes_;
  std::vector<FaultChange> faults_;
  std::vector<std::string> restarts_;
  std::vector<bool> run_full_;  // of the services of the Full level
  Utime now_ = 0;
  std::int64_t command_id_ = 0;
  PoseReport pose_;
  WheelReport wheels_;
  std::map<std::string, ServiceReport> services_;
  double coverage_ = 0.9;
  bool wheels_alive_ = true;
  bool wheels_follow_ = true;  // wheels turn if permitted
  bool imu_alive_ = true;
  bool command_alive_ = true;
  bool pose_alive_ = true;
  bool pose_usable_ = true;
  double speed_ = 0.0;
  bool planner_alive_ = true;
  PlannerReport planner_ = clear_path();
  bool control_alive_ = true;
  ControlReport control_ = following();
  bool hazards_alive_ = true;
  Utime hazards_period_ = 400'000;
  bool blind_ = false;
  double slip_ = 0.05;
  bool slip_valid_ = true;
  std::string dead_service_;
};

TEST_F(SupervisorTest, BootWaitsForEveryServiceAndThePose) {
  dead_service_ = "path_planner";
  run(3.0);
  EXPECT_EQ(supervisor_.state(), State::kBoot);
  dead_service_.clear();
  pose_usable_ = false;
  run(3.0);
  EXPECT_EQ(supervisor_.state(), State::kBoot);
  EXPECT_TRUE(faults_.empty());
  pose_usable_ = true;
  run(0.2);
  EXPECT_EQ(supervisor_.state(), State::kStandby);
  EXPECT_FALSE(out_.permit.granted);
}

TEST_F(SupervisorTest, GoNeedsStandbyAndAPath) {
  EXPECT_FALSE(command(CommandKind::kGo).accepted);
  run(2.0);
  planner_.path_id = -1;
  run(0.1);
  const CommandAnswer refused = command(CommandKind::kGo);
  EXPECT_FALSE(refused.accepted);
  EXPECT_EQ(refused.reason, "no path_present");
  planner_.path_id = 1;
  run(0.1);
  EXPECT_TRUE(command(CommandKind::kGo).accepted);
  EXPECT_EQ(supervisor_.state(), State::kDriving);
  EXPECT_TRUE(out_.permit.granted);
  EXPECT_EQ(command(CommandKind::kGo).reason, "not possible in DRIVING");
}

TEST_F(SupervisorTest, UnknownCommandsAreRefused) {
  run(2.0);
  for (const CommandKind kind : {CommandKind::kInject, static_cast<CommandKind>(99), static_cast<CommandKind>(-5)})
    EXPECT_FALSE(command(kind).accepted);
  EXPECT_EQ(supervisor_.state(), State::kStandby);
}

TEST_F(SupervisorTest, StalePoseStopsAndClearsByItself) {
  start_driving();
  pose_alive_ = false;
  EXPECT_LE(time_to_withdrawal(), 0.32);
  EXPECT_EQ(supervisor_.state(), State::kFaultStop);
  EXPECT_EQ(changes_.back().cause, "pose_age");
  EXPECT_EQ(changes_.back().evidence.quantity, "pose_age_s");
  EXPECT_GT(changes_.back().evidence.value, 0.3);
  EXPECT_EQ(changes_.back().evidence.threshold, 0.3);
  run(5.0);
  EXPECT_FALSE(out_.permit.granted);
  pose_alive_ = true;
  EXPECT_NEAR(time_to_permit(), 1.0, 0.05);
  EXPECT_EQ(supervisor_.state(), State::kDriving);
  EXPECT_EQ(changes_.back().cause, "faults_cleared");
}

TEST_F(SupervisorTest, LostPoseStopsAtOnce) {
  start_driving();
  pose_usable_ = false;
  EXPECT_LE(time_to_withdrawal(), 0.02);
  EXPECT_EQ(changes_.back().cause, "pose_status");
}

TEST_F(SupervisorTest, StaleHazardsStop) {
  start_driving();
  hazards_alive_ = false;
  const double seconds = time_to_withdrawal();
  EXPECT_GT(seconds, 0.5);  // one lost frame is not a fault
  EXPECT_LE(seconds, 1.2);
  EXPECT_EQ(changes_.back().cause, "hazards_age");
}

TEST_F(SupervisorTest, ThreeBlindFramesStop) {
  start_driving();
  blind_ = true;
  const double seconds = time_to_withdrawal();
  EXPECT_GT(seconds, 0.8);
  EXPECT_LE(seconds, 1.2);
  EXPECT_EQ(changes_.back().cause, "hazards_blind");
  blind_ = false;
  EXPECT_LE(time_to_permit(), 1.45);
}

// The LocCam does not see where the reversing rover goes. Only the path followed by the planner counts.
TEST_F(SupervisorTest, BlindFramesAllowBacktracking) {
  start_driving();
  blind_ = true;
  time_to_withdrawal();
  EXPECT_EQ(faults_.back().response, Response::kStopBacktrack);
  run(20.0);
  EXPECT_FALSE(out_.permit.granted);
  PathLevels back;
  back.path_id = 2;
  back.backtrack = true;
  supervisor_.on_path(back);
  run(5.0);
  EXPECT_FALSE(out_.permit.granted) << "another path is followed";
  planner_.path_id = control_.path_id = 2;
  EXPECT_LE(time_to_permit(), 1.45);
  planner_.path_id = control_.path_id = 3;
  EXPECT_LE(time_to_withdrawal(), 0.5);
}

TEST_F(SupervisorTest, ExcessiveRollAllowsBacktrackingUpToItsLimit) {
  start_driving();
  pose_.roll_rad = to_rad(-20.5);
  time_to_withdrawal();
  EXPECT_EQ(changes_.back().cause, "roll");
  run(20.0);
  EXPECT_FALSE(out_.permit.granted);
  PathLevels back;
  back.path_id = planner_.path_id = control_.path_id = 2;
  back.backtrack = true;
  supervisor_.on_path(back);
  EXPECT_LE(time_to_permit(), 1.1);
  pose_.roll_rad = to_rad(-23.5);
  EXPECT_LE(time_to_withdrawal(), 0.1);
  EXPECT_EQ(changes_.back().cause, "roll");
  EXPECT_EQ(changes_.back().evidence.threshold, 23.0);
}

// A wall 3 m ahead: the row stops the rover before its front (0.9 m) is there, with what it needs to stop.
TEST_F(SupervisorTest, AZoneStopsTheRoverAtItsStoppingDistance) {
  start_driving();
  PathLevels path;
  path.path_id = planner_.path_id;
  path.zones = {{"dune", false, {{3, -5}, {6, -5}, {6, 5}, {3, 5}}}};
  supervisor_.on_path(path);
  speed_ = 0.2;
  pose_.odom.x_m = 1.0;
  run(1.0);
  ASSERT_TRUE(out_.permit.granted);
  double stopped_at_m = 0.0;
  for (double x_m = 1.0; x_m < 2.2 && out_.permit.granted; x_m += 0.004) {
    pose_.odom.x_m = stopped_at_m = x_m;
    run(0.02);
  }
  EXPECT_LT(stopped_at_m + config_.footprint_half_length_m + 0.2 * 0.2 / (2.0 * config_.deceleration_mps2), 3.0);
  EXPECT_GT(stopped_at_m + config_.footprint_half_length_m, 2.6);
  EXPECT_EQ(changes_.back().cause, "keep_out");
}

TEST_F(SupervisorTest, ARoverThatAPoseCorrectionPutIntoAZoneMayBackUp) {
  start_driving();
  PathLevels path;
  path.path_id = planner_.path_id;
  path.zones = {{"dune", false, {{0.5, -5}, {6, -5}, {6, 5}, {0.5, 5}}}};
  supervisor_.on_path(path);
  time_to_withdrawal();
  EXPECT_EQ(changes_.back().cause, "keep_out");
  path.path_id = planner_.path_id = control_.path_id = 2;
  path.backtrack = true;
  supervisor_.on_path(path);
  EXPECT_LE(time_to_permit(), 1.5);
}

TEST_F(SupervisorTest, BackingUpWithoutFaultHasTheOrdinaryLimits) {
  start_driving();
  PathLevels back;
  back.path_id = planner_.path_id = control_.path_id = 2;
  back.backtrack = true;
  supervisor_.on_path(back);
  run(1.0);
  ASSERT_TRUE(out_.permit.granted);
  pose_.roll_rad = to_rad(20.5);
  EXPECT_LE(time_to_withdrawal(), 0.1);
  EXPECT_EQ(changes_.back().evidence.threshold, 20.0);
}

// At the end of a path after a fault the planner may back up again, for want of a path.
TEST_F(SupervisorTest, BackingUpAgainWithoutFaultHasTheOrdinaryLimits) {
  start_driving();
  pose_.roll_rad = to_rad(20.5);
  time_to_withdrawal();
  PathLevels back;
  back.path_id = planner_.path_id = control_.path_id = 2;
  back.backtrack = true;
  supervisor_.on_path(back);
  EXPECT_LE(time_to_permit(), 1.5);
  speed_ = 0.1;
  run(1.0);
  back.path_id = planner_.path_id = control_.path_id = 3;
  supervisor_.on_path(back);
  run(1.0);
  ASSERT_TRUE(out_.permit.granted) << "the path has changed on its way";
  speed_ = pose_.roll_rad = 0.0;
  run(5.0);
  back.path_id = planner_.path_id = control_.path_id = 4;
  supervisor_.on_path(back);
  run(1.0);
  ASSERT_TRUE(out_.permit.granted);
  pose_.roll_rad = to_rad(20.5);
  EXPECT_LE(time_to_withdrawal(), 0.1);
  EXPECT_EQ(changes_.back().evidence.threshold, 20.0);
}

TEST_F(SupervisorTest, NanStopsWhileBacktracking) {
  start_driving();
  blind_ = true;
  time_to_withdrawal();
  PathLevels back;
  back.path_id = planner_.path_id = control_.path_id = 2;
  back.backtrack = true;
  supervisor_.on_path(back);
  time_to_permit();
  pose_.roll_rad = kNaN;
  EXPECT_LE(time_to_withdrawal(), 0.1);
}

TEST_F(SupervisorTest, StalePlannerOrControllerStops) {
  start_driving();
  planner_alive_ = false;
  EXPECT_LE(time_to_withdrawal(), 0.32);
  EXPECT_EQ(changes_.back().cause, "planner_age");
  planner_alive_ = true;
  time_to_permit();
  control_alive_ = false;
  EXPECT_LE(time_to_withdrawal(), 0.32);
  EXPECT_EQ(changes_.back().cause, "control_age");
}

TEST_F(SupervisorTest, MissingHeartbeatStops) {
  for (const std::string& service : config_.fdir.required_services) {
    SCOPED_TRACE(service);
    if (supervisor_.state() == State::kBoot) start_driving();
    pose_.travelled_m += 5.0;  // avoids the row fault_stops, which counts per distance
    dead_service_ = service;
    EXPECT_LE(time_to_withdrawal(), 1.3);
    EXPECT_EQ(changes_.back().cause, "heartbeat." + service);
    dead_service_.clear();
    EXPECT_LE(time_to_permit(), 1.2);
  }
}

TEST_F(SupervisorTest, OutOfCorridorStops) {
  start_driving();
  control_.out_of_corridor = true;
  control_.cross_track_m = -0.8;
  EXPECT_LE(time_to_withdrawal(), 0.02);
  EXPECT_EQ(changes_.back().cause, "out_of_corridor");
  EXPECT_EQ(changes_.back().evidence.value, -0.8);
  EXPECT_EQ(changes_.back().evidence.threshold, 0.75);
}

TEST_F(SupervisorTest, ControllerOnAnotherPathStops) {
  start_driving();
  planner_.path_id = 2;
  run(0.5);
  control_.path_id = 2;
  run(2.0);
  EXPECT_TRUE(out_.permit.granted);
  planner_.path_id = 3;
  EXPECT_NEAR(time_to_withdrawal(), 1.0, 0.05);
  EXPECT_EQ(changes_.back().cause, "path_mismatch");
}

TEST_F(SupervisorTest, PlannerWithoutPathIsNotAPathMismatch) {
  start_driving();
  planner_.path_id = -1;
  planner_.state = PlannerState::kNoPath;
  speed_ = 0.0;
  run(25.0);
  ASSERT_FALSE(faults_.empty());
  EXPECT_EQ(faults_.front().id, "no_path");
}

TEST_F(SupervisorTest, SlipStopsAndClearsAtRest) {
  start_driving();
  slip_ = 0.9;
  EXPECT_LE(time_to_withdrawal(), 0.2);
  EXPECT_EQ(changes_.back().cause, "slip");
  slip_ = kNaN;
  slip_valid_ = false;
  EXPECT_NEAR(time_to_permit(), 3.0, 0.1);
}

TEST_F(SupervisorTest, TwoFaultsAreIndependent) {
  for (const bool pose_first_to_clear : {true, false}) {
    if (supervisor_.state() == State::kBoot) start_driving();
    pose_alive_ = false;
    run(1.0);
    control_.out_of_corridor = true;
    planner_alive_ = false;
    run(1.0);
    EXPECT_EQ(supervisor_.active_faults().front(), "pose_age");
    EXPECT_EQ(std::count_if(faults_.begin(), faults_.end(), [](const FaultChange& f) { return f.active && f.first; }),
              pose_first_to_clear ? 1 : 2);
    (pose_first_to_clear ? pose_alive_ : planner_alive_) = true;
    run(5.0);
    EXPECT_EQ(supervisor_.state(), State::kFaultStop);
    EXPECT_FALSE(out_.permit.granted);
    pose_alive_ = planner_alive_ = true;
    control_.out_of_corridor = false;
    EXPECT_NEAR(time_to_permit(), 1.0, 0.05);
    EXPECT_TRUE(supervisor_.active_faults().empty());
  }
}

TEST_F(SupervisorTest, HazardAheadStopsRepairsAndResumes) {
  start_driving();
  speed_ = 0.2;
  planner_.state = PlannerState::kRepairing;
  planner_.blocked_in_m = 0.26;
  run(1.0);
  EXPECT_TRUE(out_.permit.granted);
  planner_.blocked_in_m = 0.24;
  tick();
  EXPECT_FALSE(out_.permit.granted);
  EXPECT_EQ(supervisor_.state(), State::kHazardStop);
  EXPECT_EQ(supervisor_.hazard_stops(), 1);
  EXPECT_EQ(changes_.back().evidence.quantity, "blocked_in_m");
  EXPECT_EQ(changes_.back().evidence.value, 0.24);
  run(0.5);
  EXPECT_EQ(supervisor_.state(), State::kHazardStop);
  speed_ = 0.0;
  run(0.1);
  EXPECT_EQ(supervisor_.state(), State::kRepairing);
  planner_ = clear_path();
  planner_.path_id = control_.path_id = 2;
  tick();
  EXPECT_EQ(supervisor_.state(), State::kDriving);
  EXPECT_TRUE(out_.permit.granted);
  EXPECT_EQ(supervisor_.hazard_stops(), 1);
}

TEST_F(SupervisorTest, ThePermittedSpeedFallsWithTheFreeDistance) {
  start_driving();
  double last = config_.max_speed_mps;
  for (const double free_m : {1.0, 0.15, 0.1, 0.05, 0.02}) {
    planner_.blocked_in_m = config_.stop_distance_m + free_m;
    tick();
    ASSERT_TRUE(out_.permit.granted);
    const double v = out_.permit.max_speed_mps;
    EXPECT_LE(v, last);
    EXPECT_LE(v * v / (2.0 * config_.deceleration_mps2), free_m + 1e-9);
    last = v;
  }
  EXPECT_LT(last, 0.08);
  planner_.blocked_in_m = config_.stop_distance_m + 1e-4;
  tick();
  EXPECT_GT(out_.permit.max_speed_mps, 0.0) << "it comes to its stop";
}

TEST_F(SupervisorTest, TheRoverDrivesAtMostSoFarFromOneFrameToTheNext) {
  start_driving();
  run(1.0);
  EXPECT_EQ(out_.permit.max_speed_mps, config_.max_speed_mps);
  config_.advance_per_frame_m = 0.06;
  supervisor_ = Supervisor(config_);
  start_driving();
  run(1.0);
  EXPECT_NEAR(out_.permit.max_speed_mps, 0.06 / 0.4, 1e-9);
  hazards_period_ = 800'000;
  run(2.0);
  EXPECT_NEAR(out_.permit.max_speed_mps, 0.06 / 0.8, 1e-9);
}

TEST_F(SupervisorTest, StopHysteresisAppliesToTheSamePathOnly) {
  start_driving();
  planner_.blocked_in_m = 0.24;
  tick();
  planner_.blocked_in_m = 0.35;
  run(1.0);
  EXPECT_FALSE(out_.permit.granted);
  planner_.path_id = control_.path_id = 2;
  tick();
  EXPECT_TRUE(out_.permit.granted);
}

TEST_F(SupervisorTest, NanBlockDistanceAndMissingPathCountAsBlocked) {
  start_driving();
  planner_.blocked_in_m = kNaN;
  tick();
  EXPECT_EQ(supervisor_.state(), State::kHazardStop);
  planner_ = clear_path();
  tick();
  EXPECT_EQ(supervisor_.state(), State::kDriving);
  planner_.path_id = -1;
  tick();
  EXPECT_EQ(supervisor_.state(), State::kHazardStop);
}

TEST_F(SupervisorTest, FaultDuringAHazardStopReturnsToHazardStop) {
  start_driving();
  planner_.blocked_in_m = 0.2;
  tick();
  pose_alive_ = false;
  run(1.0);
  EXPECT_EQ(supervisor_.state(), State::kFaultStop);
  pose_alive_ = true;
  run(3.0);
  EXPECT_EQ(supervisor_.state(), State::kHazardStop);
  EXPECT_EQ(supervisor_.hazard_stops(), 1);
  for (const StateChange& change : changes_) EXPECT_NE(change.to, State::kDriving);
}

TEST_F(SupervisorTest, NoPathStopsWithThatCauseAndIsLatched) {
  start_driving();
  planner_.state = PlannerState::kNoPath;
  planner_.blocked_in_m = 0.2;
  run(19.0);
  EXPECT_EQ(supervisor_.state(), State::kHazardStop);
  run(2.0);
  EXPECT_EQ(supervisor_.state(), State::kFaultStop);
  EXPECT_EQ(changes_.back().cause, "no_path");
  planner_ = clear_path();
  run(5.0);
  EXPECT_EQ(supervisor_.state(), State::kFaultStop);  // latched
  EXPECT_TRUE(command(CommandKind::kClearFault, "no_path").accepted);
  EXPECT_EQ(supervisor_.state(), State::kDriving);
}

TEST_F(SupervisorTest, ActiveConditionIsNotClearedByCommand) {
  start_driving();
  planner_.state = PlannerState::kNoPath;
  planner_.blocked_in_m = 0.2;
  run(21.0);
  EXPECT_FALSE(command(CommandKind::kClearFault, "no_path").accepted);
  EXPECT_FALSE(command(CommandKind::kClearFault, "unknown").accepted);
  EXPECT_EQ(supervisor_.state(), State::kFaultStop);
}

TEST_F(SupervisorTest, BlockedForSixtySecondsEndsTheDrive) {
  start_driving();
  planner_.blocked_in_m = 0.2;
  run(59.0);
  EXPECT_EQ(supervisor_.state(), State::kHazardStop);
  run(2.0);
  EXPECT_EQ(supervisor_.state(), State::kFaultStop);
  EXPECT_EQ(changes_.back().cause, "blocked");
  EXPECT_TRUE(command(CommandKind::kStop).accepted);
  EXPECT_EQ(supervisor_.state(), State::kStandby);
  run(0.1);
  EXPECT_TRUE(supervisor_.active_faults().empty());
}

// Farther than the stopping distance, nearer than what the rover drives on with.
TEST_F(SupervisorTest, AStopThatNoPlanEndsEndsTheDrive) {
  start_driving();
  planner_.blocked_in_m = 0.2;
  speed_ = 0.0;
  run(2.0);
  planner_.blocked_in_m = 0.35;
  run(61.0);
  EXPECT_EQ(supervisor_.state(), State::kFaultStop);
  EXPECT_EQ(changes_.back().cause, "blocked");
}

TEST_F(SupervisorTest, GoalNeedsPathEndAndGoalDistance) {
  start_driving();
  control_.path_end = true;
  planner_.goal_distance_m = 3.0;
  run(0.5);
  EXPECT_EQ(supervisor_.state(), State::kDriving);
  planner_.goal_distance_m = kNaN;
  run(0.5);
  EXPECT_EQ(supervisor_.state(), State::kDriving);
  planner_.goal_distance_m = 0.1;
  tick();
  EXPECT_EQ(supervisor_.state(), State::kGoalReached);
  EXPECT_FALSE(out_.permit.granted);
  run(2.0);
  EXPECT_EQ(supervisor_.state(), State::kGoalReached);
  EXPECT_TRUE(command(CommandKind::kStop).accepted);
  EXPECT_EQ(supervisor_.state(), State::kStandby);
}

TEST_F(SupervisorTest, PauseAndResume) {
  start_driving();
  EXPECT_TRUE(command(CommandKind::kPause).accepted);
  EXPECT_FALSE(out_.permit.granted);
  run(2.0);
  EXPECT_EQ(supervisor_.state(), State::kPaused);
  pose_alive_ = false;
  run(1.0);
  EXPECT_FALSE(command(CommandKind::kResume).accepted);
  pose_alive_ = true;
  run(2.0);
  EXPECT_TRUE(command(CommandKind::kResume).accepted);
  EXPECT_TRUE(out_.permit.granted);
}

TEST_F(SupervisorTest, EmergencyStopIsLatched) {
  start_driving();
  EXPECT_TRUE(command(CommandKind::kEmergencyStop).accepted);
  EXPECT_EQ(supervisor_.state(), State::kSafe);
  EXPECT_FALSE(out_.permit.granted);
  run(5.0);
  for (const CommandKind kind : {CommandKind::kGo, CommandKind::kResume, CommandKind::kStop, CommandKind::kPause})
    EXPECT_FALSE(command(kind).accepted);
  EXPECT_TRUE(command(CommandKind::kClearSafe).accepted);
  EXPECT_EQ(supervisor_.state(), State::kStandby);
  EXPECT_FALSE(out_.permit.granted);
}

TEST_F(SupervisorTest, CommandsOfOneTickAreExecutedInOrder) {
  start_driving();
  supervisor_.on_command({1, CommandKind::kPause, "", {}});
  supervisor_.on_command({2, CommandKind::kEmergencyStop, "", {}});
  supervisor_.on_command({3, CommandKind::kResume, "", {}});
  tick();
  ASSERT_EQ(out_.answers.size(), 3u);
  EXPECT_TRUE(out_.answers[0].accepted);
  EXPECT_TRUE(out_.answers[1].accepted);
  EXPECT_FALSE(out_.answers[2].accepted);
  EXPECT_EQ(supervisor_.state(), State::kSafe);
}

TEST_F(SupervisorTest, OldHeartbeatsAreIgnored) {
  start_driving();
  supervisor_.on_service("stereo", {});
  tick();
  EXPECT_TRUE(out_.permit.granted);
}

struct RowCase {
  const char* id;
  std::function<void(PoseReport&, WheelReport&, double)> set;
  double at_limit, beyond;
};

// Each row: not raised just below its limit, raised beyond it and by NaN, cleared afterwards.
TEST_F(SupervisorTest, AttitudeAndCurrentsStopBeyondTheirLimitsAndOnNan) {
  const std::vector<RowCase> cases = {
      {"roll", [](PoseReport& p, WheelReport&, double v) { p.roll_rad = to_rad(v); }, 19.9, -20.1},
      {"pitch", [](PoseReport& p, WheelReport&, double v) { p.pitch_rad = to_rad(v); }, -34.9, 35.1},
      {"tilt_rate", [](PoseReport& p, WheelReport&, double v) { p.tilt_rate_radps = to_rad(v); }, 29.9, 30.1},
      {"pose_sigma", [](PoseReport& p, WheelReport&, double v) { p.sigma_m = v; }, 2.9, 3.1},
      {"drive_current.ML", [](PoseReport&, WheelReport& w, double v) { w.drive_current_a[2] = v; }, -9.9, -10.1},
  };
  for (const RowCase& row : cases)
    for (const double bad : {row.beyond, kNaN}) {
      SCOPED_TRACE(std::string(row.id) + " " + std::to_string(bad));
      if (supervisor_.state() == State::kBoot) start_driving();
      pose_.travelled_m += 5.0;
      row.set(pose_, wheels_, row.at_limit);
      run(1.0);
      ASSERT_TRUE(out_.permit.granted);
      row.set(pose_, wheels_, bad);
      EXPECT_LE(time_to_withdrawal(), 1.05);
      EXPECT_EQ(changes_.back().cause, row.id);
      row.set(pose_, wheels_, 0.0);
      EXPECT_LE(time_to_permit(), 2.2);
    }
}

// The driver limits the current of a stalled servo, so the row is below that limit. The persistence leaves time for
// stall recovery.
TEST_F(SupervisorTest, LastingServoStallStops) {
  start_driving();
  wheels_.steer_current_a[3] = 0.89;
  run(5.0);
  ASSERT_TRUE(out_.permit.granted);
  wheels_.steer_current_a[3] = 1.0;
  const double seconds = time_to_withdrawal(30.0);
  EXPECT_GT(seconds, 12.0);
  EXPECT_LT(seconds, 13.5);
  EXPECT_EQ(changes_.back().cause, "steer_current.RR");
  wheels_.steer_current_a[3] = 0.0;
  EXPECT_LE(time_to_permit(), 2.2);
}

TEST_F(SupervisorTest, MotorI2tLoadStopsBelowTheCurrentLimit) {
  start_driving();
  wheels_.drive_current_a[0] = 5.0;  // 1.6 times nominal
  const double seconds = time_to_withdrawal(300.0);
  EXPECT_GT(seconds, 20.0);
  EXPECT_LT(seconds, 60.0);
  EXPECT_EQ(changes_.back().cause, "drive_heat.FL");
  wheels_.drive_current_a[0] = 0.0;
  EXPECT_GT(time_to_permit(120.0), 20.0);
}

TEST_F(SupervisorTest, SilentOrFaultySensorsStop) {
  start_driving();
  imu_alive_ = false;
  EXPECT_LE(time_to_withdrawal(), 0.24);
  EXPECT_EQ(changes_.back().cause, "imu_age");
  imu_alive_ = true;
  time_to_permit();
  wheels_alive_ = false;
  EXPECT_LE(time_to_withdrawal(), 0.24);
  EXPECT_EQ(changes_.back().cause, "wheel_state_age");
  wheels_alive_ = true;
  time_to_permit();
  wheels_.fault = true;
  EXPECT_LE(time_to_withdrawal(), 0.04);
  EXPECT_EQ(changes_.back().cause, "wheel_fault");
  wheels_.fault = false;
  time_to_permit();
  command_alive_ = false;
  EXPECT_LE(time_to_withdrawal(), 0.34);
  EXPECT_EQ(changes_.back().cause, "command_age");
}

TEST_F(SupervisorTest, SlowRowsReduceTheSpeedInSteps) {
  start_driving();
  EXPECT_EQ(out_.permit.max_speed_mps, config_.max_speed_mps);
  pose_.roll_rad = to_rad(16.0);
  run(0.2);
  EXPECT_TRUE(out_.permit.granted);
  EXPECT_EQ(out_.permit.max_speed_mps, 0.10);
  pose_.roll_rad = to_rad(18.0);
  run(0.2);
  EXPECT_TRUE(out_.permit.granted);
  EXPECT_EQ(out_.permit.max_speed_mps, 0.05);  // lowest speed of the active rows
  pose_.roll_rad = to_rad(16.0);
  run(1.1);
  EXPECT_EQ(out_.permit.max_speed_mps, 0.10);
  pose_.roll_rad = 0.0;
  run(1.1);
  EXPECT_EQ(out_.permit.max_speed_mps, config_.max_speed_mps);
}

TEST_F(SupervisorTest, PredictedCorridorViolationStopsADeviatingRover) {
  start_driving();
  control_.predicted_error_m = 1.2 * control_.corridor_half_width_m;
  run(1.0);
  EXPECT_TRUE(out_.permit.granted);  // the prediction is pessimistic, so it is ignored near the path
  control_.cross_track_m = 0.5 * control_.corridor_half_width_m;
  EXPECT_LE(time_to_withdrawal(), 0.1);
  EXPECT_EQ(changes_.back().cause, "corridor_predicted");
  EXPECT_EQ(faults_.back().response, Response::kStopReplan);
}

TEST_F(SupervisorTest, ClockStepStops) {
  start_driving();
  now_ += to_utime(0.8);
  tick();
  EXPECT_FALSE(out_.permit.granted);
  EXPECT_EQ(changes_.back().cause, "clock_step");
  EXPECT_LE(time_to_permit(), 2.0);
  EXPECT_TRUE(restarts_.empty());  // no service is restarted
}

TEST_F(SupervisorTest, SilentServiceIsRestartedThreeTimesThenSafe) {
  start_driving();
  dead_service_ = "stereo";
  run(1.5);
  EXPECT_EQ(restarts_, std::vector<std::string>{"stereo"});
  run(5.0);
  EXPECT_EQ(restarts_.size(), 2u);
  run(20.0);
  EXPECT_EQ(supervisor_.state(), State::kSafe);
  EXPECT_EQ(changes_.back().cause, "restart_failed.stereo");
  // The service is healthy again, but SAFE needs a ground command.
  dead_service_.clear();
  run(70.0);
  EXPECT_EQ(supervisor_.state(), State::kSafe);
  EXPECT_TRUE(command(CommandKind::kClearSafe).accepted);
}

TEST_F(SupervisorTest, RepeatedServiceStartsLeadToSafe) {
  start_driving();
  restart_services(4);
  EXPECT_EQ(supervisor_.state(), State::kSafe);
  EXPECT_EQ(changes_.back().cause, "starts.hazard_detector");
  EXPECT_FALSE(command(CommandKind::kClearSafe).accepted);  // the fault is still active
  EXPECT_TRUE(command(CommandKind::kClearFault, "starts.hazard_detector").accepted);
  EXPECT_TRUE(command(CommandKind::kClearSafe).accepted);
}

TEST_F(SupervisorTest, ServiceFaultStatusRestartsTheService) {
  start_driving();
  services_["stereo"].status = ServiceStatus::kFault;
  EXPECT_LE(time_to_withdrawal(), 0.5);
  EXPECT_EQ(changes_.back().cause, "service_fault.stereo");
  EXPECT_EQ(restarts_, std::vector<std::string>{"stereo"});
}

TEST_F(SupervisorTest, MessageLossIsLoggedThenStops) {
  start_driving();
  services_["stereo"].lost += 400;  // of 14000 in the window
  run(1.0);
  EXPECT_TRUE(out_.permit.granted);
  ASSERT_EQ(faults_.size(), 1u);
  EXPECT_EQ(faults_[0].id, "message_loss_high");
  for (int i = 0; i < 25 && out_.permit.granted; ++i) {
    for (auto& [name, report] : services_) report.lost += 80;
    run(0.2);
  }
  EXPECT_EQ(changes_.back().cause, "message_loss");
}

TEST_F(SupervisorTest, UnpermittedMotionLeadsToSafe) {
  start_driving();
  command(CommandKind::kPause);
  wheels_follow_ = false;
  wheels_.drive_rate_radps.fill(1.0);
  run(2.5);
  EXPECT_EQ(supervisor_.state(), State::kPaused);
  run(1.0);
  EXPECT_EQ(supervisor_.state(), State::kSafe);
  EXPECT_EQ(changes_.back().cause, "unpermitted_motion");
}

// That the wheels turned when last heard of is no evidence of motion; that they still turn afterwards is.
TEST_F(SupervisorTest, SilentWheelsAreNotUnpermittedMotion) {
  start_driving();
  wheels_alive_ = false;
  run(10.0);
  EXPECT_FALSE(out_.permit.granted);
  EXPECT_EQ(changes_.back().cause, "wheel_state_age");
  wheels_follow_ = false;
  wheels_alive_ = true;
  run(0.1);
  EXPECT_EQ(supervisor_.state(), State::kSafe);
  EXPECT_EQ(changes_.back().cause, "unpermitted_motion");
}

// For example a deadlock between planner and controller.
TEST_F(SupervisorTest, UnusedPermitRequestsANewPath) {
  start_driving();
  wheels_follow_ = false;
  wheels_.drive_rate_radps.fill(0.0);
  run(29.0);
  EXPECT_TRUE(faults_.empty());
  run(2.0);
  ASSERT_FALSE(faults_.empty());
  EXPECT_EQ(faults_[0].id, "idle_drive");
  EXPECT_EQ(supervisor_.state(), State::kFaultStop);
}

TEST_F(SupervisorTest, TeleoperationNeedsFreshCommandsAndIsSlow) {
  run(2.0);
  EXPECT_TRUE(command(CommandKind::kTeleop).accepted);
  EXPECT_EQ(supervisor_.state(), State::kTeleop);
  EXPECT_TRUE(out_.permit.granted);
  EXPECT_EQ(out_.permit.max_speed_mps, config_.teleop_speed_mps);
  EXPECT_NEAR(time_to_withdrawal(), 0.5, 0.05);
  EXPECT_EQ(supervisor_.state(), State::kTeleop);
  EXPECT_TRUE(command(CommandKind::kTeleop).accepted);
  EXPECT_TRUE(out_.permit.granted);
  pose_alive_ = false;
  for (int i = 0; i < 20; ++i) command(CommandKind::kTeleop);
  EXPECT_FALSE(out_.permit.granted);
  EXPECT_EQ(supervisor_.state(), State::kStandby);
  EXPECT_EQ(changes_.back().cause, "pose_age");
}

TEST_F(SupervisorTest, RestartKeepsLatchedFaults) {
  start_driving();
  planner_.state = PlannerState::kNoPath;
  planner_.blocked_in_m = 0.2;
  run(21.0);
  ASSERT_EQ(supervisor_.active_faults(), std::vector<std::string>{"no_path"});
  restart_supervisor();
  planner_ = clear_path();
  run(5.0);
  EXPECT_EQ(supervisor_.state(), State::kFaultStop);  // still latched after the restart
  EXPECT_TRUE(command(CommandKind::kClearFault, "no_path").accepted);
  EXPECT_EQ(supervisor_.state(), State::kDriving);
  EXPECT_TRUE(restarts_.empty());
}

// At 4 A a cold winding takes 84 s to the limit of drive_heat.
TEST_F(SupervisorTest, RestartKeepsMotorHeat) {
  start_driving();
  wheels_.drive_current_a[0] = 4.0;
  run(60.0);
  ASSERT_TRUE(out_.permit.granted);
  restart_supervisor();
  EXPECT_LE(time_to_permit(), 2.0);
  EXPECT_LE(time_to_withdrawal(60.0), 30.0);
  EXPECT_EQ(changes_.back().cause, "drive_heat.FL");
}

TEST_F(SupervisorTest, InfiniteCurrentDoesNotEndTheHeatModel) {
  wheels_.drive_current_a[0] = kInfinity;
  run(1.0);
  EXPECT_EQ(supervisor_.persistent_state().heat.drive_i2t_load[0], 0.0);
}

TEST_F(SupervisorTest, RestartKeepsTheBacktrackLimit) {
  start_driving();
  pose_.roll_rad = to_rad(-20.5);
  time_to_withdrawal();
  PathLevels back;
  back.path_id = planner_.path_id = control_.path_id = 2;
  back.backtrack = true;
  supervisor_.on_path(back);
  time_to_permit();
  run(3.0);
  const std::vector<std::string> slow = {"roll_high", "roll_steep"};
  ASSERT_EQ(supervisor_.active_faults(), slow);
  restart_supervisor(back);
  run(4.0);
  EXPECT_TRUE(out_.permit.granted);
  EXPECT_EQ(supervisor_.active_faults(), slow);
  pose_.roll_rad = to_rad(-23.5);
  EXPECT_LE(time_to_withdrawal(), 0.1);
  EXPECT_EQ(changes_.back().evidence.threshold, 23.0);
}

TEST_F(SupervisorTest, RestartKeepsTheCountOfServiceStarts) {
  start_driving();
  restart_services(2);
  restart_supervisor();
  run(1.0);
  restart_services(2);
  EXPECT_EQ(supervisor_.state(), State::kSafe);
  EXPECT_EQ(changes_.back().cause, "starts.hazard_detector");
}

TEST_F(SupervisorTest, RestartKeepsTheCountOfRestartAttempts) {
  start_driving();
  dead_service_ = "stereo";
  run(6.5);
  ASSERT_EQ(restarts_.size(), 2u);
  restart_supervisor();
  run(11.0);
  EXPECT_EQ(supervisor_.state(), State::kSafe);
  EXPECT_EQ(changes_.back().cause, "restart_failed.stereo");
  EXPECT_EQ(restarts_.size(), 4u);
}

TEST_F(SupervisorTest, RestartKeepsTheCountOfFaultStops) {
  start_driving();
  const auto fault_stops = [&](int times) {
    for (int i = 0; i < times; ++i) {
      pose_usable_ = false;
      pose_.travelled_m = i % 2 == 0 ? kNaN : 0.0;  // an invalid odometer is not counted as a position
      run(0.5);
      pose_usable_ = true;
      pose_.travelled_m = 0.0;
      run(2.0);
    }
  };
  fault_stops(3);
  EXPECT_EQ(supervisor_.persistent_state().counters.fault_stops_m, (std::deque<double>(3, 0.0)));
  restart_supervisor();
  run(3.0);
  fault_stops(3);
  EXPECT_EQ(supervisor_.state(), State::kSafe);
  EXPECT_EQ(changes_.back().cause, "fault_stops");
}

TEST_F(SupervisorTest, RefusedClearFaultKeepsTheCounters) {
  start_driving();
  restart_services(3);
  planner_.state = PlannerState::kNoPath;
  planner_.blocked_in_m = 0.2;
  run(21.0);
  EXPECT_FALSE(command(CommandKind::kClearFault, "no_path").accepted);
  EXPECT_FALSE(command(CommandKind::kClearFault, "unknown").accepted);
  restart_services(1);
  EXPECT_EQ(supervisor_.state(), State::kSafe);
  EXPECT_EQ(changes_.back().cause, "starts.hazard_detector");
}

TEST_F(SupervisorTest, ClearFaultOfAnInactiveFaultResetsTheCounters) {
  start_driving();
  restart_services(3);
  EXPECT_TRUE(command(CommandKind::kClearFault, "starts.hazard_detector").accepted);
  EXPECT_TRUE(out_.faults.empty());
  restart_services(3);
  EXPECT_NE(supervisor_.state(), State::kSafe);
}

TEST_F(SupervisorTest, RestartResumesTheStateWhenInputsAreHealthy) {
  for (const auto& [before, after] : {std::pair(State::kDriving, State::kDriving),
                                      {State::kRepairing, State::kDriving},
                                      {State::kSafe, State::kSafe},
                                      {State::kPaused, State::kPaused},
                                      {State::kStandby, State::kStandby},
                                      {State::kTeleop, State::kStandby},
                                      {State::kGoalReached, State::kGoalReached}}) {
    SCOPED_TRACE(name(before));
    supervisor_ = Supervisor(config_);
    PersistentState persistent_state;
    persistent_state.state = before;
    persistent_state.hazard_stops = 3;
    persistent_state.utime = now_;
    supervisor_.restore(persistent_state);
    supervisor_.on_path({1});
    tick();
    EXPECT_FALSE(out_.permit.granted);
    run(3.0);
    EXPECT_EQ(supervisor_.state(), after);
    EXPECT_EQ(supervisor_.hazard_stops(), 3);
    EXPECT_TRUE(restarts_.empty());
  }
}

// As when the disk was full: EMERGENCY_STOP may have been ordered after it was saved.
TEST_F(SupervisorTest, RestartWithAnOldOrUnusableStateIsSafe) {
  run(20.0);
  for (const double age_s : {10.1, -10.1, kNaN}) {  // NaN: unusable
    SCOPED_TRACE(age_s);
    PersistentState driving;
    driving.state = State::kDriving;
    if (!std::isnan(age_s)) driving.utime = now_ - to_utime(age_s);
    supervisor_ = Supervisor(config_);
    supervisor_.restore(std::isnan(age_s) ? std::nullopt : std::optional(driving));
    supervisor_.on_path({1});
    changes_.clear();
    run(5.0);
    EXPECT_EQ(supervisor_.state(), State::kSafe);
    ASSERT_EQ(changes_.size(), 1u);
    EXPECT_EQ(changes_[0].cause, std::isnan(age_s) ? "checkpoint_unusable" : "checkpoint_old");
    EXPECT_FALSE(command(CommandKind::kGo).accepted);
    EXPECT_TRUE(command(CommandKind::kClearSafe).accepted);
    EXPECT_TRUE(command(CommandKind::kGo).accepted);
  }
}

TEST_F(SupervisorTest, ProcessThatIsBackWithinSecondsDrivesOn) {
  start_driving();
  PersistentState saved = supervisor_.persistent_state();
  saved.utime = now_;
  now_ += to_utime(5.0);
  supervisor_ = Supervisor(config_);
  supervisor_.restore(saved);
  supervisor_.on_path({1});
  EXPECT_LE(time_to_permit(), 1.5);
}

TEST_F(SupervisorTest, RestartDoesNotDriveBeforeTheZonesAreKnown) {
  start_driving();
  restart_supervisor(std::nullopt);
  run(5.0);
  EXPECT_FALSE(out_.permit.granted);
  EXPECT_EQ(supervisor_.active_faults(), std::vector<std::string>{"keep_out"});
  PathLevels path{1};
  path.zones = {{"dune", false, {{0.5, -5}, {6, -5}, {6, 5}, {0.5, 5}}}};
  supervisor_.on_path(path);
  run(5.0);
  EXPECT_FALSE(out_.permit.granted);
  supervisor_.on_path({1});
  EXPECT_LE(time_to_permit(), 1.1);
}

TEST_F(SupervisorTest, RestartWithoutAPathIsHealthy) {
  run(2.0);
  planner_.path_id = -1;
  run(1.0);
  restart_supervisor(std::nullopt);
  run(2.0);
  EXPECT_TRUE(command(CommandKind::kTeleop).accepted);
  EXPECT_TRUE(out_.permit.granted);
}

TEST_F(SupervisorTest, RestartWhileBackingUpWithoutFaultKeepsTheOrdinaryLimits) {
  start_driving();
  PathLevels back{2};
  back.backtrack = true;
  planner_.path_id = control_.path_id = 2;
  supervisor_.on_path(back);
  restart_supervisor(std::nullopt);
  run(0.5);
  supervisor_.on_path(back);
  run(3.0);
  ASSERT_TRUE(out_.permit.granted);
  pose_.roll_rad = to_rad(20.5);
  EXPECT_LE(time_to_withdrawal(), 0.1);
  EXPECT_EQ(changes_.back().evidence.threshold, 20.0);
}

// Adds heartbeats of the Full-level services and the map.
class LevelTest : public SupervisorTest {
 protected:
  void drive(double seconds, double speed_mps) {
    for (Utime end = now_ + to_utime(seconds); now_ < end;) {
      if (full_alive_ && now_ % 200'000 == 0)
        for (const std::string& service : config_.fdir.full_services) {
          if (service == hung_) continue;
          ServiceReport report;
          report.utime = now_;
          report.boot_id = service == dying_ ? 1 + now_ / to_utime(5.0) : 1;
          supervisor_.on_service(service, report);
        }
      if (full_alive_ && map_alive_) supervisor_.on_terrain({now_, difficulty_, known_});
      const double distance_m = out_.permit.granted ? speed_mps * to_seconds(kTickUs) : 0.0;
      pose_.travelled_m += distance_m;
      planner_.goal_distance_m -= distance_m;
      control_.arc_length_m += distance_m;
      tick();
    }
  }
  void begin() {
    planner_.goal_distance_m = 500.0;
    start_driving();
  }
  const StateChange* last_level_change() const {
    for (auto it = changes_.rbegin(); it != changes_.rend(); ++it)
      if (it->level_from != it->level_to) return &*it;
    return nullptr;
  }

  bool full_alive_ = true;
  double difficulty_ = 0.8;
  KnownFractions known_{0.5, 0.6};
  bool map_alive_ = true;
  std::string hung_;
  std::string dying_;
};

TEST_F(LevelTest, SlowProgressRaisesAndEasyTerrainLowers) {
  begin();
  drive(130.0, 0.15);
  EXPECT_EQ(supervisor_.level(), Level::kEfficient);
  drive(130.0, 0.03);
  EXPECT_EQ(supervisor_.level(), Level::kFull);
  ASSERT_NE(last_level_change(), nullptr);
  EXPECT_EQ(last_level_change()->cause, "slow_progress");
  EXPECT_EQ(last_level_change()->evidence.quantity, "effective_speed_mps");
  EXPECT_LT(last_level_change()->evidence.value, 0.06);
  EXPECT_EQ(last_level_change()->evidence.threshold, 0.06);
  drive(200.0, 0.03);
  EXPECT_EQ(supervisor_.level(), Level::kFull);  // hard ground ahead
  difficulty_ = 0.1;
  drive(40.0, 0.1);
  EXPECT_EQ(supervisor_.level(), Level::kFull);  // not yet over easy_distance_m
  drive(50.0, 0.1);
  EXPECT_EQ(supervisor_.level(), Level::kEfficient);
  EXPECT_EQ(last_level_change()->cause, "easy_terrain");
}

TEST_F(LevelTest, ALongerPathIsNotSlowProgress) {
  begin();
  drive(130.0, 0.15);
  planner_.global_path_id = 7;
  planner_.goal_distance_m += 100.0;
  drive(130.0, 0.15);
  EXPECT_EQ(supervisor_.level(), Level::kEfficient);
}

TEST_F(LevelTest, ManyHazardsRaise) {
  begin();
  for (int i = 0; i < 8 && supervisor_.level() == Level::kEfficient; ++i) {
    planner_.replans += 1;
    drive(10.0, 0.15);
  }
  EXPECT_EQ(supervisor_.level(), Level::kFull);
  EXPECT_EQ(last_level_change()->cause, "many_hazards");
}

TEST_F(LevelTest, ABlindLocCamRaisesAndTheNavCamDrivesOnSlowly) {
  begin();
  blind_ = true;
  difficulty_ = 0.1;
  drive(5.0, 0.1);
  EXPECT_EQ(supervisor_.level(), Level::kFull);
  EXPECT_EQ(last_level_change()->cause, "loccam_out");
  EXPECT_EQ(last_level_change()->evidence.quantity, "blind_frames");
  EXPECT_TRUE(out_.permit.granted);
  EXPECT_LE(out_.permit.max_speed_mps, 0.1);
  drive(100.0, 0.1);
  EXPECT_EQ(supervisor_.level(), Level::kFull) << "easy ground does not lower the level of a blind LocCam";
  EXPECT_TRUE(command(CommandKind::kPause).accepted);
  drive(5.0, 0.1);
  EXPECT_TRUE(command(CommandKind::kResume).accepted) << "the level stays while paused";
  hazards_alive_ = false;
  drive(5.0, 0.1);
  EXPECT_TRUE(out_.permit.granted);
  map_alive_ = false;
  drive(30.0, 0.1);
  EXPECT_EQ(supervisor_.state(), State::kSweeping) << "neither camera sees";
  map_alive_ = hazards_alive_ = true;
  blind_ = false;
  drive(150.0, 0.1);
  EXPECT_EQ(supervisor_.level(), Level::kEfficient);
}

TEST_F(LevelTest, ABlindLocCamStopsTheRoverIfTheGroundWantsEfficient) {
  begin();
  EXPECT_TRUE(command(CommandKind::kForceLevel, "", ForcedLevel::kEfficient).accepted);
  blind_ = true;
  drive(5.0, 0.1);
  EXPECT_EQ(supervisor_.level(), Level::kEfficient);
  EXPECT_EQ(supervisor_.state(), State::kFaultStop);
}

TEST_F(LevelTest, NoPathAtTheEfficientLevelRaises) {
  begin();
  speed_ = 0.0;
  planner_.state = PlannerState::kNoPath;
  planner_.blocked_in_m = 0.0;
  drive(2.0, 0.0);
  EXPECT_EQ(supervisor_.level(), Level::kFull);
  EXPECT_EQ(last_level_change()->cause, "no_path");
  drive(30.0, 0.0);
  EXPECT_EQ(faults_.front().id, "no_path") << "both levels have looked";
}

TEST_F(LevelTest, PathSegmentsRaiseAndLower) {
  begin();
  supervisor_.on_path({1, {0.0, 10.0, 20.0}, {Level::kEfficient, Level::kFull, Level::kEfficient}});
  drive(60.0, 0.15);
  EXPECT_EQ(supervisor_.level(), Level::kEfficient);
  drive(10.0, 0.15);
  EXPECT_EQ(supervisor_.level(), Level::kFull);
  EXPECT_EQ(last_level_change()->cause, "path_segment");
  drive(70.0, 0.15);
  EXPECT_EQ(supervisor_.level(), Level::kEfficient);
}

TEST_F(LevelTest, WithoutAPlaceOnThePathItsLevelStays) {
  begin();
  supervisor_.on_path({1, {0.0}, {Level::kFull}});
  drive(2.0, 0.15);
  ASSERT_EQ(supervisor_.level(), Level::kFull);
  control_.arc_length_m = kNaN;
  control_.stale_pose = true;
  pose_alive_ = false;
  drive(5.0, 0.0);
  EXPECT_EQ(supervisor_.level(), Level::kFull);
}

TEST_F(LevelTest, RestartKeepsTheLevelOfThePath) {
  begin();
  const PathLevels path{1, {0.0}, {Level::kFull}};
  supervisor_.on_path(path);
  drive(2.0, 0.15);
  ASSERT_EQ(supervisor_.level(), Level::kFull);
  changes_.clear();
  restart_supervisor(path);
  drive(1.0, 0.15);
  EXPECT_EQ(supervisor_.level(), Level::kFull);
  EXPECT_EQ(last_level_change(), nullptr);
}

// A busy service sends its next heartbeat up to 0.4 s after the supervisor's start.
TEST_F(LevelTest, RestartKillsNoServiceOfTheFullLevel) {
  begin();
  const PathLevels path{1, {0.0}, {Level::kFull}};
  supervisor_.on_path(path);
  drive(2.0, 0.15);
  ASSERT_EQ(supervisor_.level(), Level::kFull);
  restarts_.clear();
  restart_supervisor(path);
  full_alive_ = false;
  drive(0.4, 0.0);
  full_alive_ = true;
  drive(2.0, 0.0);
  EXPECT_TRUE(restarts_.empty());
}

// Continuous planning publishes a new path each second; the controller reports it one tick later.
TEST_F(LevelTest, NewPathOfTheSameLevelChangesNothing) {
  begin();
  supervisor_.on_path({1, {0.0}, {Level::kFull}});
  drive(2.0, 0.15);
  ASSERT_EQ(supervisor_.level(), Level::kFull);
  changes_.clear();
  for (std::int64_t id = 2; id < 20; ++id) {
    supervisor_.on_path({id, {0.0}, {Level::kFull}});
    drive(0.04, 0.15);
    planner_.path_id = control_.path_id = id;
    control_.arc_length_m = 0.0;
    drive(1.0, 0.15);
  }
  EXPECT_EQ(last_level_change(), nullptr);
  supervisor_.on_path({20, {0.0}, {Level::kEfficient}});
  drive(0.04, 0.15);
  EXPECT_EQ(supervisor_.level(), Level::kFull);
  planner_.path_id = control_.path_id = 20;
  drive(0.04, 0.15);
  EXPECT_EQ(supervisor_.level(), Level::kEfficient);
}

TEST_F(LevelTest, GroundCommandForcesAndReleases) {
  begin();
  drive(1.0, 0.1);
  EXPECT_TRUE(command(CommandKind::kForceLevel, "", ForcedLevel::kFull).accepted);
  drive(1.0, 0.1);
  EXPECT_EQ(supervisor_.level(), Level::kFull);
  difficulty_ = 0.0;
  drive(120.0, 0.15);
  EXPECT_EQ(supervisor_.level(), Level::kFull);
  EXPECT_TRUE(command(CommandKind::kForceLevel, "", ForcedLevel::kAuto).accepted);
  drive(1.0, 0.15);
  EXPECT_EQ(supervisor_.level(), Level::kEfficient);
}

TEST_F(LevelTest, NoFullLevelWithoutItsServices) {
  full_alive_ = false;
  begin();
  EXPECT_FALSE(command(CommandKind::kForceLevel, "", ForcedLevel::kFull).accepted);
  drive(300.0, 0.01);
  EXPECT_EQ(supervisor_.level(), Level::kEfficient);
  EXPECT_FALSE(command(CommandKind::kForceLevel, "", ForcedLevel::kFull).accepted) << "missing, not stopped";
  EXPECT_FALSE(command(CommandKind::kForceLevel, "", static_cast<ForcedLevel>(7)).accepted);
}

TEST_F(LevelTest, ServicesOfTheFullLevelRunOnDemand) {
  config_.on_demand_services = config_.fdir.full_services;
  supervisor_ = Supervisor(config_);
  begin();
  drive(5.0, 0.15);
  EXPECT_EQ(run_full_, std::vector<bool>{true});
  EXPECT_TRUE(supervisor_.full_services_wanted());
  drive(6.0, 0.15);
  EXPECT_FALSE(supervisor_.full_services_wanted());
  EXPECT_EQ(run_full_, (std::vector<bool>{true, false}));
  full_alive_ = false;  // as s6 was told
  drive(60.0, 0.15);
  EXPECT_TRUE(restarts_.empty());

  EXPECT_TRUE(command(CommandKind::kForceLevel, "", ForcedLevel::kFull).accepted);
  drive(1.0, 0.15);
  EXPECT_EQ(run_full_, (std::vector<bool>{true, false, true}));
  EXPECT_EQ(supervisor_.level(), Level::kEfficient) << "not before they are ready";
  full_alive_ = true;
  drive(1.0, 0.15);
  EXPECT_EQ(supervisor_.level(), Level::kFull);
  EXPECT_TRUE(restarts_.empty());
  drive(60.0, 0.15);
  EXPECT_TRUE(supervisor_.full_services_wanted());
}

// Each of them hangs before its first heartbeat.
TEST_F(LevelTest, SegmentOfTheFullLevelWaitsForServicesThatHangAtTheirStart) {
  begin();
  while (supervisor_.full_services_wanted()) drive(0.02, 0.15);
  full_alive_ = false;
  PathLevels path;
  path.path_id = control_.path_id;
  path.s_m = {0.0};
  path.level = {Level::kFull};
  supervisor_.on_path(path);
  drive(4.0, 0.15);
  EXPECT_TRUE(out_.permit.granted) << "they are starting";
  drive(2.0, 0.15);
  EXPECT_FALSE(out_.permit.granted);
  EXPECT_EQ(supervisor_.state(), State::kFaultStop);
  EXPECT_EQ(restarts_, config_.fdir.full_services);
  full_alive_ = true;
  drive(2.0, 0.15);
  EXPECT_EQ(supervisor_.level(), Level::kFull);
  EXPECT_EQ(supervisor_.state(), State::kDriving);
}

TEST_F(LevelTest, LevelDoesNotRiseWithServicesThatAreAboutToStop) {
  begin();
  while (supervisor_.full_services_wanted()) drive(0.02, 0.15);
  EXPECT_TRUE(command(CommandKind::kForceLevel, "", ForcedLevel::kFull).accepted);
  drive(0.4, 0.15);
  EXPECT_EQ(supervisor_.level(), Level::kEfficient);
  drive(1.0, 0.15);
  EXPECT_EQ(run_full_, (std::vector<bool>{true, false, true}));
  EXPECT_EQ(supervisor_.level(), Level::kFull);
}

TEST_F(LevelTest, EmptyMapIsSweptBeforeDriving) {
  begin();
  known_ = {0.0, 0.0};
  drive(1.0, 0.1);
  command(CommandKind::kForceLevel, "", ForcedLevel::kFull);
  drive(1.0, 0.1);
  EXPECT_EQ(supervisor_.state(), State::kSweeping);
  EXPECT_FALSE(out_.permit.granted);
  known_ = {0.9, 0.3};
  drive(1.0, 0.1);
  EXPECT_EQ(supervisor_.state(), State::kSweeping);  // both sides must be known too
  known_ = {0.9, 0.6};
  drive(0.1, 0.1);
  EXPECT_EQ(supervisor_.state(), State::kDriving);
  EXPECT_TRUE(out_.permit.granted);
  known_ = {0.9, 0.3};
  drive(10.0, 0.1);
  EXPECT_EQ(supervisor_.state(), State::kDriving);  // the sides matter only during a sweep
}

TEST_F(LevelTest, SweepTimeoutAcceptsKnownGroundAhead) {
  begin();
  known_ = {0.4, 0.3};
  map_alive_ = false;
  drive(1.0, 0.1);
  command(CommandKind::kForceLevel, "", ForcedLevel::kFull);
  drive(1.0, 0.1);
  map_alive_ = true;
  drive(22.0, 0.1);
  EXPECT_EQ(supervisor_.state(), State::kSweeping);
  drive(4.0, 0.1);
  EXPECT_EQ(supervisor_.state(), State::kDriving);
}

TEST_F(LevelTest, StaleMapStopsToSweep) {
  begin();
  drive(1.0, 0.1);
  command(CommandKind::kForceLevel, "", ForcedLevel::kFull);
  drive(1.0, 0.1);
  ASSERT_EQ(supervisor_.state(), State::kDriving);
  map_alive_ = false;
  const double before_m = pose_.travelled_m;
  drive(60.0, 0.1);
  EXPECT_EQ(supervisor_.state(), State::kSweeping);
  EXPECT_FALSE(out_.permit.granted);
  EXPECT_NEAR(pose_.travelled_m - before_m, 1.5, 0.01);
}

TEST_F(LevelTest, FailedSweepLowersTheLevelIfThePathAllows) {
  begin();
  for (int i = 0; i < 8 && supervisor_.level() == Level::kEfficient; ++i) {
    planner_.replans += 1;
    drive(10.0, 0.15);
  }
  ASSERT_EQ(supervisor_.level(), Level::kFull);
  map_alive_ = false;
  drive(15.0, 0.15);
  ASSERT_EQ(supervisor_.state(), State::kSweeping);
  drive(40.0, 0.15);
  EXPECT_EQ(supervisor_.level(), Level::kEfficient);
  EXPECT_EQ(last_level_change()->cause, "full_failing");
  EXPECT_EQ(last_level_change()->evidence.quantity, "sweep_s");
  EXPECT_TRUE(out_.permit.granted);
}

TEST_F(LevelTest, FailedSweepStopsIfThePathRequiresFull) {
  begin();
  supervisor_.on_path({1, {0.0}, {Level::kFull}});
  known_ = {0.0, 0.0};
  drive(58.0, 0.15);
  EXPECT_EQ(supervisor_.state(), State::kSweeping);
  drive(5.0, 0.15);
  EXPECT_EQ(supervisor_.state(), State::kFaultStop);
  known_ = {0.9, 0.9};
  drive(10.0, 0.15);
  EXPECT_FALSE(out_.permit.granted);  // latched
  EXPECT_TRUE(command(CommandKind::kClearFault, "sweep_timeout").accepted);
  drive(2.0, 0.15);
  EXPECT_TRUE(out_.permit.granted);
}

TEST_F(LevelTest, HungFullServiceDoesNotStopAtTheEfficientLevel) {
  begin();
  drive(5.0, 0.15);
  hung_ = "slam";
  const double before_m = pose_.travelled_m;
  drive(10.0, 0.15);
  EXPECT_NEAR(pose_.travelled_m - before_m, 1.5, 0.01);
  EXPECT_NE(std::find(restarts_.begin(), restarts_.end(), "slam"), restarts_.end());
  EXPECT_EQ(supervisor_.level(), Level::kEfficient);
}

TEST_F(LevelTest, HungFullServiceStopsAtTheFullLevel) {
  begin();
  drive(1.0, 0.1);
  command(CommandKind::kForceLevel, "", ForcedLevel::kFull);
  drive(1.0, 0.1);
  hung_ = "slam";
  drive(2.0, 0.1);
  EXPECT_EQ(supervisor_.state(), State::kFaultStop);
  EXPECT_NE(std::find(restarts_.begin(), restarts_.end(), "slam"), restarts_.end());
  hung_ = "";
  drive(3.0, 0.1);
  EXPECT_TRUE(out_.permit.granted);
}

TEST_F(LevelTest, RepeatedlyDyingServicesLowerTheLevelIfThePathAllows) {
  begin();
  for (int i = 0; i < 8 && supervisor_.level() == Level::kEfficient; ++i) {
    planner_.replans += 1;
    drive(10.0, 0.15);
  }
  ASSERT_EQ(supervisor_.level(), Level::kFull);
  dying_ = "point_cloud";
  drive(12.0, 0.15);
  EXPECT_EQ(supervisor_.level(), Level::kEfficient);
  EXPECT_EQ(last_level_change()->cause, "full_failing");
  EXPECT_EQ(last_level_change()->evidence.quantity, "starts_per_minute");
  drive(60.0, 0.15);
  EXPECT_EQ(supervisor_.level(), Level::kEfficient);
  EXPECT_EQ(supervisor_.state(), State::kDriving);
}

TEST_F(LevelTest, RepeatedlyDyingServicesLeadToSafeIfThePathRequiresFull) {
  begin();
  supervisor_.on_path({1, {0.0}, {Level::kFull}});
  drive(5.0, 0.15);
  ASSERT_EQ(supervisor_.level(), Level::kFull);
  dying_ = "point_cloud";
  drive(30.0, 0.15);
  EXPECT_EQ(supervisor_.state(), State::kSafe);
  EXPECT_EQ(supervisor_.level(), Level::kFull);
}

}  // namespace
}  // namespace rover::supervisor
