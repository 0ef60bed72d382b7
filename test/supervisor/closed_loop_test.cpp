// Supervisor, trajectory control and locomotion in closed loop with a kinematic rover; planner and sensors are mocked.
#include <gtest/gtest.h>

#include "supervisor/config.hpp"
#include "supervisor/supervisor.hpp"
#include "test/trajectory_control/drive_loop.hpp"

namespace rover::supervisor {
namespace {

using control::ControlState;

constexpr double kWheelRadiusM = 0.125;

class MissionTest : public testing::Test {
 protected:
  MissionTest() { loop_.permitted = false; }

  void tick() {
    loop_.tick();
    const Utime made = loop_.now - kTickUs;
    if (loop_.pose_alive) {
      PoseReport pose;
      pose.utime = pose.vo_utime = made;
      pose.usable = true;
      pose.speed_mps = loop_.speed();
      pose.turn_rate_radps = loop_.rover.twist().turn_radps;
      supervisor_.on_pose(pose);
    }
    WheelReport wheels;
    wheels.utime = made;
    wheels.drive_rate_radps.fill(loop_.speed() / kWheelRadiusM);
    supervisor_.on_wheels(wheels);
    supervisor_.on_imu({made, false});
    supervisor_.on_motion_command(made);
    if (hazards_alive_ && loop_.now % 400'000 == 0) supervisor_.on_hazards({made - 220'000, false, 0.9});
    ServiceReport alive;
    alive.utime = made;
    alive.boot_id = 1;
    if (loop_.now % 200'000 == 0)
      for (const std::string& service : config_.fdir.required_services) supervisor_.on_service(service, alive);
    PlannerReport planner;
    planner.utime = made;
    planner.state = planner_state_;
    planner.path_id = path_id_;
    planner.blocked_in_m = blocked_at_m_ - loop_.output.arc_length_m;
    if (std::isinf(blocked_at_m_)) planner.blocked_in_m = kInfinity;
    planner.goal_distance_m = loop_.output.remaining_m;
    supervisor_.on_planner(planner);
    if (loop_.control_alive) {
      ControlReport control;
      control.utime = made;
      control.path_end = loop_.output.state == ControlState::kPathEnd;
      control.out_of_corridor = loop_.output.state == ControlState::kOutOfCorridor;
      control.path_id = loop_.output.path_id;
      supervisor_.on_control(control);
    }
    if (!supervisor_alive_) return;
    const SupervisorOutput out = supervisor_.step(loop_.now);
    loop_.permitted = out.permit.granted;
    for (const StateChange& change : out.changes) changes_.push_back(change);
  }
  void run(double seconds) {
    for (Utime end = loop_.now + to_utime(seconds); loop_.now < end;) tick();
  }
  void follow(const std::vector<Eigen::Vector2d>& points) { loop_.controller.set_path({++path_id_, 0.75, points}); }
  void go() {
    run(2.0);
    supervisor_.on_command({1, CommandKind::kGo, "", {}});
    tick();
    ASSERT_EQ(supervisor_.state(), State::kDriving);
  }

  SupervisorConfig config_ = load_config(test::config_dir());
  Supervisor supervisor_{config_};
  test::DriveLoop loop_;
  std::vector<StateChange> changes_;
  std::int64_t path_id_ = 0;
  PlannerState planner_state_ = PlannerState::kFollowing;
  double blocked_at_m_ = kInfinity;
  bool hazards_alive_ = true;
  bool supervisor_alive_ = true;
};

TEST_F(MissionTest, DrivesTheSeedTraverseToItsGoal) {
  follow(test::polyline(test::seed_traverse()));
  run(3.0);
  EXPECT_EQ(loop_.speed(), 0.0);
  go();
  double squares = 0.0;
  int count = 0;
  while (supervisor_.state() == State::kDriving && loop_.now < to_utime(900.0)) {
    tick();
    squares += loop_.output.cross_track_m * loop_.output.cross_track_m;
    ++count;
  }
  EXPECT_EQ(supervisor_.state(), State::kGoalReached);
  EXPECT_LT(std::sqrt(squares / count), 0.05);
  run(2.0);
  EXPECT_LT(loop_.speed(), 1e-3);
  EXPECT_LT(std::abs(loop_.output.remaining_m), 0.05);
  EXPECT_EQ(supervisor_.hazard_stops(), 0);
  EXPECT_EQ(changes_.size(), 3u);  // STANDBY, DRIVING, GOAL_REACHED
}

TEST_F(MissionTest, StopsBeforeAHazardAndResumesOnANewPath) {
  follow({{0.0, 0.0}, {20.0, 0.0}});
  blocked_at_m_ = 5.0;
  go();
  run(35.0);
  EXPECT_EQ(supervisor_.state(), State::kHazardStop);
  EXPECT_LT(loop_.speed(), 1e-3);
  const double gap = 5.0 - loop_.rover.pose().x_m;
  EXPECT_GT(gap, 0.1);
  EXPECT_LT(gap, 0.25);
  planner_state_ = PlannerState::kRepairing;
  run(0.5);
  EXPECT_EQ(supervisor_.state(), State::kRepairing);
  planner_state_ = PlannerState::kFollowing;
  blocked_at_m_ = kInfinity;
  follow({{loop_.rover.pose().x_m, 0.0}, {8.0, 2.0}, {20.0, 2.0}});
  run(5.0);
  EXPECT_EQ(supervisor_.state(), State::kDriving);
  EXPECT_GT(loop_.speed(), 0.05);
}

TEST_F(MissionTest, StopsOnAnyStaleInputAndRecovers) {
  follow({{0.0, 0.0}, {100.0, 0.0}});
  go();
  run(5.0);
  const auto stops_and_recovers = [this](bool& alive, const char* cause) {
    SCOPED_TRACE(cause);
    ASSERT_GT(loop_.speed(), 0.15);
    alive = false;
    run(2.0);
    EXPECT_EQ(supervisor_.state(), State::kFaultStop);
    EXPECT_EQ(changes_.back().cause, cause);
    EXPECT_LT(loop_.speed(), 1e-3);
    alive = true;
    run(6.0);
    EXPECT_EQ(supervisor_.state(), State::kDriving);
  };
  stops_and_recovers(loop_.pose_alive, "pose_age");
  stops_and_recovers(loop_.control_alive, "control_age");
  stops_and_recovers(hazards_alive_, "hazards_age");
}

TEST_F(MissionTest, DeadSupervisorStopsTheRover) {
  follow({{0.0, 0.0}, {20.0, 0.0}});
  go();
  run(10.0);
  const double x = loop_.rover.pose().x_m;
  supervisor_alive_ = false;
  loop_.permit_alive = false;
  run(1.0);
  EXPECT_LT(loop_.speed(), 0.01);
  EXPECT_LT(loop_.rover.pose().x_m - x, 0.15);
}

}  // namespace
}  // namespace rover::supervisor
