#include "tools/report/time_account.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numeric>

#include "common/core/time.hpp"
#include "known_run.hpp"

namespace rover::report {
namespace {

constexpr double kWheelRadiusM = 0.125;
const VehicleWheels kWheels;

// Samples each tick. Each phase sets the wheels and the control state of its time.
class TimedRun {
 public:
  explicit TimedRun(State state) { run_.states.push_back({0.0, state, false, ""}); }

  TimedRun& state(State state, const std::string& cause = "") {
    run_.states.push_back({to_seconds(now_), state, false, cause});
    return *this;
  }
  TimedRun& path() {
    run_.local_paths.push_back({to_seconds(now_), static_cast<std::int64_t>(run_.local_paths.size()), true, true, {}});
    return *this;
  }
  TimedRun& unseen(bool on) {
    unseen_ = on;
    return *this;
  }
  // Left and right wheels, front wheels, rate of all steered wheels.
  TimedRun& drive(double for_s, double left_mps, double right_mps, double steer_rad = 0.0, double steer_radps = 0.0,
                  Following following = Following::kFollowing) {
    for (const Utime end = now_ + to_utime(for_s); now_ < end; now_ += kTickUs, steer_rad += steer_radps * 0.02) {
      WheelSample sample;
      sample.t_s = to_seconds(now_);
      for (size_t i = 0; i < 6; ++i) sample.rate_radps[i] = (i % 2 == 0 ? left_mps : right_mps) / kWheelRadiusM;
      sample.steer_rad = {steer_rad, steer_rad, -steer_rad, -steer_rad};
      run_.wheels.push_back(sample);
      run_.control.push_back({sample.t_s, following, 1, 0.0});
      run_.planner.push_back({sample.t_s, false, unseen_, 0});
    }
    return *this;
  }
  TimedRun& rest(double for_s, Following following = Following::kFollowing) {
    return drive(for_s, 0.0, 0.0, 0.0, 0.0, following);
  }

  TimeAccount account() const { return account_time(run_, kWheels, {0.0, to_seconds(now_)}); }
  double seconds() const { return to_seconds(now_); }
  const RunRecord& record() const { return run_; }

 private:
  RunRecord run_;
  Utime now_ = 0;
  bool unseen_ = false;
};

double sum(const TimeAccount& account) {
  return std::accumulate(account.seconds.begin(), account.seconds.end(), 0.0);
}

// Front wheels of an arc of this curvature, as for a bicycle.
double steer_of(double curvature_per_m) {
  return std::atan(curvature_per_m * 0.75);
}

TEST(TimeAccount, WheelsTellStraightCurveReverseAndPointTurnApart) {
  TimedRun run(State::kDriving);
  run.drive(2.0, 0.2, 0.2).drive(1.0, 0.2, 0.2, steer_of(0.09)).drive(3.0, 0.18, 0.22, steer_of(-0.11));
  run.drive(4.0, -0.1, -0.2, steer_of(0.3)).drive(5.0, -0.15, 0.15, 0.0, 0.0, Following::kPointTurn);
  const TimeAccount account = run.account();
  EXPECT_NEAR(account.of(TimeCause::kStraight), 3.0, 1e-9);
  EXPECT_NEAR(account.of(TimeCause::kCurve), 3.0, 1e-9);
  EXPECT_NEAR(account.of(TimeCause::kReverse), 4.0, 1e-9);
  EXPECT_NEAR(account.of(TimeCause::kPointTurn), 5.0, 1e-9);
  EXPECT_NEAR(sum(account), run.seconds(), 1e-9);
}

TEST(TimeAccount, AtRestTheTurningCornerWheelsAreSteering) {
  TimedRun run(State::kDriving);
  run.drive(1.0, 0.2, 0.2).drive(5.0, 0.001, -0.001, 0.0, to_rad(11.0)).rest(0.5, Following::kPathEnd).rest(2.0);
  const TimeAccount account = run.account();
  EXPECT_NEAR(account.of(TimeCause::kSteering), 5.1, 0.11) << "the rate is over 0.1 s";
  EXPECT_NEAR(account.of(TimeCause::kOther), 2.0, 0.11) << "neither steering nor without a path";
  EXPECT_NEAR(sum(account), 8.5, 1e-9);
}

TEST(TimeAccount, AtRestWithoutAPathItWaitsForAPlan) {
  TimedRun run(State::kDriving);
  run.drive(1.0, 0.2, 0.2).rest(3.0, Following::kPathEnd).rest(2.0, Following::kIdle).drive(1.0, 0.2, 0.2);
  EXPECT_NEAR(run.account().of(TimeCause::kWaitingForPlan), 5.0, 1e-9);
}

TEST(TimeAccount, StopThatEndsOnTheSamePathIsAHazardStop) {
  TimedRun run(State::kDriving);
  run.path().drive(1.0, 0.2, 0.2).state(State::kHazardStop).drive(0.5, 0.1, 0.1).rest(2.5);
  run.state(State::kDriving).drive(1.0, 0.2, 0.2).path().drive(1.0, 0.2, 0.2);
  const TimeAccount account = run.account();
  EXPECT_NEAR(account.of(TimeCause::kHazardStop), 3.0, 1e-9);
  EXPECT_EQ(account.of(TimeCause::kWaitingForPlan), 0.0);
}

TEST(TimeAccount, StopThatASweepEndsOnTheSamePathIsAHazardStop) {
  for (const State between : {State::kSweeping, State::kPaused, State::kFaultStop}) {
    TimedRun run(State::kDriving);
    run.path().drive(1.0, 0.2, 0.2).state(State::kHazardStop).rest(2.0).state(between).rest(13.0);
    run.state(State::kDriving).drive(1.0, 0.2, 0.2).path().drive(1.0, 0.2, 0.2);
    const TimeAccount account = run.account();
    EXPECT_NEAR(account.of(TimeCause::kHazardStop), 2.0, 1e-9) << static_cast<int>(between);
    EXPECT_EQ(account.of(TimeCause::kWaitingForPlan), 0.0) << static_cast<int>(between);
  }
}

TEST(TimeAccount, StopWaitsForAPlanFromRestUntilTheNewPath) {
  TimedRun run(State::kDriving);
  run.path().drive(1.0, 0.2, 0.2).state(State::kHazardStop).drive(0.5, 0.1, 0.1).rest(1.0).state(State::kRepairing);
  run.rest(3.0).path().rest(0.1).state(State::kDriving).drive(1.0, 0.2, 0.2);
  const TimeAccount account = run.account();
  EXPECT_NEAR(account.of(TimeCause::kHazardStop), 0.6, 1e-9) << "braking, and from the path to the permit";
  EXPECT_NEAR(account.of(TimeCause::kWaitingForPlan), 4.0, 1e-9);
}

TEST(TimeAccount, DriveThatFindsNoPathWaitsUntilItsEnd) {
  TimedRun run(State::kDriving);
  run.path().drive(1.0, 0.2, 0.2).state(State::kHazardStop).rest(20.0);
  EXPECT_NEAR(run.account().of(TimeCause::kWaitingForPlan), 20.0, 1e-9);
  run.state(State::kFaultStop, "no_path").rest(5.0);
  EXPECT_NEAR(run.account().of(TimeCause::kWaitingForPlan), 20.0, 1e-9);
  EXPECT_NEAR(run.account().of(TimeCause::kFault), 5.0, 1e-9);
}

TEST(TimeAccount, UnseenGroundAndBlindCamerasAreBlind) {
  TimedRun run(State::kDriving);
  run.state(State::kHazardStop)
      .unseen(true)
      .rest(2.0)
      .unseen(false)
      .rest(1.0)
      .state(State::kDriving)
      .drive(1, 0.2, 0.2);
  run.state(State::kFaultStop, "hazards_blind").rest(4.0).state(State::kFaultStop, "pose_age").rest(3.0);
  run.state(State::kSafe, "hazards_age").rest(2.0);
  const TimeAccount account = run.account();
  EXPECT_NEAR(account.of(TimeCause::kBlind), 6.0, 1e-9);
  EXPECT_NEAR(account.of(TimeCause::kHazardStop), 1.0, 1e-9);
  EXPECT_NEAR(account.of(TimeCause::kFault), 5.0, 1e-9);
}

TEST(TimeAccount, SweepsAndPausesHaveTheirCause) {
  TimedRun run(State::kSweeping);
  run.rest(13.0).state(State::kPaused).rest(2.0).state(State::kTeleop).drive(3.0, 0.1, 0.1);
  EXPECT_NEAR(run.account().of(TimeCause::kSweep), 13.0, 1e-9);
  EXPECT_NEAR(run.account().of(TimeCause::kOther), 5.0, 1e-9);
}

TEST(TimeAccount, UnknownWheelsAreNoMotion) {
  TimedRun run(State::kDriving);
  run.drive(1.0, 0.2, 0.2);
  const TimeAccount account = account_time(run.record(), kWheels, {0.0, 3.0});
  EXPECT_NEAR(account.of(TimeCause::kStraight), 1.18, 0.03);
  EXPECT_NEAR(sum(account), 3.0, 1e-9);
}

// A window that ends between two ticks, and no state at all.
TEST(TimeAccount, SecondsAddUpToAnyWindow) {
  EXPECT_NEAR(sum(account_time(RunRecord{}, kWheels, {1.0, 2.007})), 1.007, 1e-9);
  const Metrics m = figures(straight_run(10.0));
  EXPECT_NEAR(sum(m.time), m.duration_s, 1e-6);
}

TEST(Reverse, OnlyMotionAgainstTheHeadingCounts) {
  RunRecord run = straight_run(10.0);
  EXPECT_EQ(figures(run).reverse_m, 0.0);
  for (TruthSample& truth : run.truth)
    if (truth.t_s > 55.0) truth.T_map_body.translation().x() = 10.0 - 0.1 * (truth.t_s - 5.0);
  EXPECT_NEAR(figures(run).reverse_m, 5.0, 0.11);
  for (TruthSample& truth : run.truth) truth.T_map_body = truth.T_map_body * pose_at(0.0, 0.0, M_PI);
  EXPECT_NEAR(figures(run).reverse_m, 5.0, 0.11) << "the other half, driven with the tail ahead";
  EXPECT_TRUE(std::isnan(figures(RunRecord{}).reverse_m));
}

TEST(Progress, IsPlannedLengthAtTopSpeedOverTime) {
  EXPECT_NEAR(figures(straight_run(10.0)).progress, 10.0 / (0.2 * 100.0), 1e-9);
  RunRecord detour = straight_run(10.0);
  detour.global_paths = {{0.0, 1, false, false, {{0.0, 0.0}, {5.0, 0.0}}}};
  EXPECT_NEAR(figures(detour).progress, 0.25, 1e-9) << "driven 10 m for 5 m planned";
  EXPECT_TRUE(std::isnan(figures(RunRecord{}).progress));
}

TEST(Progress, OfADriveThatGivesUpCountsThePartMadeGood) {
  RunRecord run = straight_run(10.0);
  run.states.back() = {55.0, State::kFaultStop, false, "no_path"};
  for (TruthSample& truth : run.truth)
    truth.T_map_body = pose_at(std::min(truth.T_map_body.translation().x(), 5.0), truth.t_s > 40.0 ? 2.0 : 0.0);
  // To the end of the log, 110 s: 5 m of the path in 105 s.
  EXPECT_NEAR(figures(run).progress, 5.0 / (0.2 * 105.0), 1e-6);
}

}  // namespace
}  // namespace rover::report
