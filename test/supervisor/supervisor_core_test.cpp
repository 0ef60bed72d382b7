// Behaviour of the supervisor: streams that live, fall silent or turn bad, and the ground's commands.
#include <gtest/gtest.h>

#include <algorithm>

#include "supervisor/config.hpp"
#include "supervisor/supervisor.hpp"

namespace rover::supervisor {
namespace {

// Healthy streams at their rates, each of which a test may silence or alter.
class SupervisorTest : public testing::Test {
 protected:
  void tick() {
    now_ += kTickUs;
    const Utime made = now_ - kTickUs;
    if (pose_alive_) supervisor_.on_pose({made, pose_usable_, speed_, 0.0});
    if (planner_alive_) {
      planner_.utime = made;
      supervisor_.on_planner(planner_);
    }
    if (control_alive_) {
      control_.utime = made;
      supervisor_.on_control(control_);
    }
    if (hazards_alive_ && now_ % 400'000 == 0) supervisor_.on_hazards({now_ - 240'000, blind_});
    if (now_ % 100'000 == 0)
      for (const std::string& service : config_.required_services)
        if (service != dead_service_) supervisor_.on_heartbeat(service, made);
    supervisor_.on_slip({made, true, slip_});
    out_ = supervisor_.step(now_);
    for (const StateChange& change : out_.changes) changes_.push_back(change);
    for (const FaultChange& change : out_.faults) faults_.push_back(change);
    EXPECT_TRUE(!out_.permit.granted || supervisor_.state() == State::kDriving);
    EXPECT_TRUE(!out_.permit.granted || out_.permit.valid_until == now_ + 200'000);
    EXPECT_TRUE(out_.permit.granted || out_.permit.valid_until == now_);
  }
  void run(double seconds) {
    for (Utime end = now_ + to_utime(seconds); now_ < end;) tick();
  }
  CommandAnswer command(CommandKind kind, const std::string& target = "") {
    supervisor_.on_command({++command_id_, kind, target});
    tick();
    EXPECT_EQ(out_.answers.size(), 1u);
    EXPECT_EQ(out_.answers.at(0).id, command_id_);
    return out_.answers.at(0);
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
  // Seconds from now until the permit is withdrawn.
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
  Utime now_ = 0;
  std::int64_t command_id_ = 0;
  bool pose_alive_ = true;
  bool pose_usable_ = true;
  double speed_ = 0.0;
  bool planner_alive_ = true;
  PlannerReport planner_ = clear_path();
  bool control_alive_ = true;
  ControlReport control_ = following();
  bool hazards_alive_ = true;
  bool blind_ = false;
  double slip_ = 0.05;
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
  for (const CommandKind kind : {CommandKind::kTeleop, CommandKind::kForceLevel, CommandKind::kInject,
                                 static_cast<CommandKind>(99), static_cast<CommandKind>(-5)})
    EXPECT_FALSE(command(kind).accepted);
  EXPECT_EQ(supervisor_.state(), State::kStandby);
}

TEST_F(SupervisorTest, AStalePoseStopsAndClearsByItself) {
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

TEST_F(SupervisorTest, ALostPoseStopsAtOnce) {
  start_driving();
  pose_usable_ = false;
  EXPECT_LE(time_to_withdrawal(), 0.02);
  EXPECT_EQ(changes_.back().cause, "pose_status");
}

TEST_F(SupervisorTest, SilentHazardsStop) {
  start_driving();
  hazards_alive_ = false;
  const double seconds = time_to_withdrawal();
  EXPECT_GT(seconds, 0.5);  // one lost frame is no fault
  EXPECT_LE(seconds, 1.2);
  EXPECT_EQ(changes_.back().cause, "hazards_age");
}

TEST_F(SupervisorTest, BlindHazardsStopAfterSomeFrames) {
  start_driving();
  blind_ = true;
  const double seconds = time_to_withdrawal();
  EXPECT_GT(seconds, 0.8);
  EXPECT_LE(seconds, 1.2);
  EXPECT_EQ(changes_.back().cause, "hazards_blind");
  blind_ = false;
  EXPECT_LE(time_to_permit(), 1.45);
}

TEST_F(SupervisorTest, ASilentPlannerOrControllerStops) {
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

TEST_F(SupervisorTest, ADeadServiceStops) {
  for (const std::string& service : config_.required_services) {
    SCOPED_TRACE(service);
    if (supervisor_.state() == State::kBoot) start_driving();
    dead_service_ = service;
    EXPECT_LE(time_to_withdrawal(), 1.1);
    EXPECT_EQ(changes_.back().cause, "heartbeat." + service);
    dead_service_.clear();
    EXPECT_LE(time_to_permit(), 1.2);
  }
}

TEST_F(SupervisorTest, OutOfTheCorridorStops) {
  start_driving();
  control_.out_of_corridor = true;
  control_.cross_track_m = -0.8;
  EXPECT_LE(time_to_withdrawal(), 0.02);
  EXPECT_EQ(changes_.back().cause, "out_of_corridor");
  EXPECT_EQ(changes_.back().evidence.value, -0.8);
  EXPECT_EQ(changes_.back().evidence.threshold, 0.75);
}

TEST_F(SupervisorTest, AControllerOnAnotherPathStops) {
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

TEST_F(SupervisorTest, SlipIsLoggedOnly) {
  start_driving();
  slip_ = 0.9;
  run(6.0);
  EXPECT_TRUE(out_.permit.granted);
  ASSERT_EQ(faults_.size(), 1u);
  EXPECT_EQ(faults_[0].id, "slip");
  EXPECT_EQ(faults_[0].response, Response::kLog);
}

// The original clears the newest fault and reports nominal while another stands (reference, fault 8).
TEST_F(SupervisorTest, TwoFaultsEachStandForThemselves) {
  for (const bool pose_first_to_clear : {true, false}) {
    if (supervisor_.state() == State::kBoot) start_driving();
    pose_alive_ = false;
    run(1.0);
    control_.out_of_corridor = true;
    planner_alive_ = false;
    run(1.0);
    EXPECT_EQ(supervisor_.standing_faults().front(), "pose_age");
    EXPECT_EQ(std::count_if(faults_.begin(), faults_.end(), [](const FaultChange& f) { return f.standing && f.first; }),
              pose_first_to_clear ? 1 : 2);
    (pose_first_to_clear ? pose_alive_ : planner_alive_) = true;
    run(5.0);
    EXPECT_EQ(supervisor_.state(), State::kFaultStop);
    EXPECT_FALSE(out_.permit.granted);
    pose_alive_ = planner_alive_ = true;
    control_.out_of_corridor = false;
    EXPECT_NEAR(time_to_permit(), 1.0, 0.05);
    EXPECT_TRUE(supervisor_.standing_faults().empty());
  }
}

TEST_F(SupervisorTest, AHazardAheadStopsRepairsAndGoesOn) {
  start_driving();
  speed_ = 0.2;
  planner_.state = PlannerState::kRepairing;
  planner_.block_kind = BlockKind::kHazard;
  planner_.blocked_in_m = 0.51;
  run(1.0);
  EXPECT_TRUE(out_.permit.granted);
  planner_.blocked_in_m = 0.49;
  tick();
  EXPECT_FALSE(out_.permit.granted);
  EXPECT_EQ(supervisor_.state(), State::kHazardStop);
  EXPECT_EQ(supervisor_.hazard_stops(), 1);
  EXPECT_EQ(changes_.back().evidence.quantity, "blocked_in_m");
  EXPECT_EQ(changes_.back().evidence.value, 0.49);
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

TEST_F(SupervisorTest, HysteresisHoldsOnTheSamePathAndNotOnANewOne) {
  start_driving();
  planner_.block_kind = BlockKind::kHazard;
  planner_.blocked_in_m = 0.49;
  tick();
  planner_.blocked_in_m = 0.6;
  run(1.0);
  EXPECT_FALSE(out_.permit.granted);
  planner_.path_id = control_.path_id = 2;
  tick();
  EXPECT_TRUE(out_.permit.granted);
}

TEST_F(SupervisorTest, UnseenGroundHasAShorterStoppingDistance) {
  start_driving();
  planner_.block_kind = BlockKind::kUnseen;
  planner_.blocked_in_m = 0.26;
  run(1.0);
  EXPECT_TRUE(out_.permit.granted);
  planner_.blocked_in_m = 0.24;
  tick();
  EXPECT_EQ(supervisor_.state(), State::kHazardStop);
}

TEST_F(SupervisorTest, ABlockThatIsNoNumberOrAMissingPathIsABlock) {
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

TEST_F(SupervisorTest, AFaultDuringAHazardStopDoesNotForgetTheHazard) {
  start_driving();
  planner_.block_kind = BlockKind::kHazard;
  planner_.blocked_in_m = 0.3;
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

TEST_F(SupervisorTest, NoPathEndsTheDriveWithItsName) {
  start_driving();
  planner_.state = PlannerState::kNoPath;
  planner_.block_kind = BlockKind::kHazard;
  planner_.blocked_in_m = 0.4;
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

TEST_F(SupervisorTest, AFaultThatStillHoldsIsNotClearedByCommand) {
  start_driving();
  planner_.state = PlannerState::kNoPath;
  planner_.blocked_in_m = 0.4;
  run(21.0);
  EXPECT_FALSE(command(CommandKind::kClearFault, "no_path").accepted);
  EXPECT_FALSE(command(CommandKind::kClearFault, "unknown").accepted);
  EXPECT_EQ(supervisor_.state(), State::kFaultStop);
}

TEST_F(SupervisorTest, StandingBeforeABlockForTooLongEndsTheDrive) {
  start_driving();
  planner_.block_kind = BlockKind::kHazard;
  planner_.blocked_in_m = 0.4;
  run(59.0);
  EXPECT_EQ(supervisor_.state(), State::kHazardStop);
  run(2.0);
  EXPECT_EQ(supervisor_.state(), State::kFaultStop);
  EXPECT_EQ(changes_.back().cause, "blocked");
  EXPECT_TRUE(command(CommandKind::kStop).accepted);
  EXPECT_EQ(supervisor_.state(), State::kStandby);
  run(0.1);
  EXPECT_TRUE(supervisor_.standing_faults().empty());
}

TEST_F(SupervisorTest, TheGoalNeedsThePathsEndAndTheDistance) {
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

TEST_F(SupervisorTest, AnEmergencyStopIsLatched) {
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

TEST_F(SupervisorTest, CommandsOfOneTickAreCarriedOutInTheirOrder) {
  start_driving();
  supervisor_.on_command({1, CommandKind::kPause, ""});
  supervisor_.on_command({2, CommandKind::kEmergencyStop, ""});
  supervisor_.on_command({3, CommandKind::kResume, ""});
  tick();
  ASSERT_EQ(out_.answers.size(), 3u);
  EXPECT_TRUE(out_.answers[0].accepted);
  EXPECT_TRUE(out_.answers[1].accepted);
  EXPECT_FALSE(out_.answers[2].accepted);
  EXPECT_EQ(supervisor_.state(), State::kSafe);
}

TEST_F(SupervisorTest, OldHeartbeatsDoNotMakeAServiceYoungerOrOlder) {
  start_driving();
  supervisor_.on_heartbeat("stereo", 0);
  tick();
  EXPECT_TRUE(out_.permit.granted);
}

}  // namespace
}  // namespace rover::supervisor
