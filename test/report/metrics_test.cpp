#include "tools/report/metrics.hpp"

#include <gtest/gtest.h>

#include "known_run.hpp"

namespace rover::report {
namespace {

TEST(Metrics, StraightRunHasKnownMetrics) {
  const Metrics m = figures(straight_run(10.0));
  EXPECT_EQ(m.outcome, "goal_reached");
  EXPECT_DOUBLE_EQ(m.planned_length_m, 10.0);
  EXPECT_NEAR(m.driven_length_m, 10.0, 1e-9);
  EXPECT_NEAR(m.path_ratio, 1.0, 1e-9);
  EXPECT_DOUBLE_EQ(m.duration_s, 100.0);
  EXPECT_NEAR(m.duty, 0.5, 1e-9);
  EXPECT_NEAR(m.mean_speed_m_per_h, 360.0, 1e-6);
  EXPECT_NEAR(m.final_error_m, 0.0, 1e-9);
  EXPECT_NEAR(m.truth_deviation_max_m, 0.0, 1e-9);
  EXPECT_DOUBLE_EQ(m.min_clearance_m, 0.3);
  EXPECT_EQ(m.collisions, 0);
  EXPECT_DOUBLE_EQ(m.time_in_state_s.at("DRIVING"), 100.0);
}

TEST(Metrics, UnknownMetricsAreNaN) {
  const Metrics m = figures(straight_run(10.0));
  EXPECT_FALSE(m.rocks_missed.has_value());
  EXPECT_FALSE(m.false_stops.has_value());
  EXPECT_TRUE(std::isnan(m.slam_drift_percent));
  EXPECT_TRUE(std::isnan(m.realtime_factor));
  const Metrics empty = figures(RunRecord{});
  EXPECT_TRUE(std::isnan(empty.driven_length_m));
  EXPECT_TRUE(std::isnan(empty.odometry_drift_percent));
  EXPECT_FALSE(empty.final_truth_pose.has_value());
  EXPECT_EQ(empty.outcome, "timeout");
}

TEST(Metrics, ContactsWithinOneSecondAreOneCollision) {
  RunRecord run = straight_run(10.0);
  for (const size_t i : {40u, 41u, 42u, 80u}) run.truth[i].collision = true;
  const Metrics m = figures(run);
  EXPECT_EQ(m.collisions, 2);
  EXPECT_EQ(m.outcome, "collision");
}

TEST(Metrics, MotionAfterPermitExpiryIsCounted) {
  RunRecord run;
  for (int i = 0; i <= 1000; ++i) {
    TruthSample sample;
    sample.t_s = 0.02 * i;
    sample.speed_mps = i < 700 ? 0.2 : 0.0;
    run.truth.push_back(sample);
  }
  run.permits = {{0.0, 4.0}, {9.0, 9.2}};
  // Moving until 14 s; leases until 4 s and from 9 s until 9.2 s, and three seconds to stop after each.
  EXPECT_NEAR(evaluate(run, {}, {}, std::nullopt).metrics.motion_without_lease_s, 2.0 + 1.8, 0.05);
  run.permits.clear();
  EXPECT_NEAR(evaluate(run, {}, {}, std::nullopt).metrics.motion_without_lease_s, 14.0, 0.05);
}

TEST(Metrics, OutcomeOfFailedRuns) {
  RunRecord run = straight_run(10.0);
  run.states.back().state = State::kFaultStop;
  EXPECT_EQ(figures(run).outcome, "fault_stop");
  run.planner = {{100.0, true, false, 3}};
  EXPECT_EQ(figures(run).outcome, "no_path");
  run.planner.clear();
  run.states.pop_back();
  EXPECT_EQ(figures(run).outcome, "timeout");
}

TEST(Metrics, ALogThatEndsEarlyIsNotATimeout) {
  RunRecord run = straight_run(10.0);
  run.states.pop_back();
  run.planner = {{60.0, true, false, 3}};
  run.bus.missing_end_s = 40.0;
  const auto outcome = [&](const char* reported) {
    RunInfo info;
    info.outcome_hint = reported;
    return evaluate(run, info, Footprint{}, std::nullopt).metrics.outcome;
  };
  EXPECT_EQ(outcome("goal_reached"), "stopped") << "neither what the simulator saw nor the last record";
  EXPECT_EQ(outcome(""), "stopped");
  EXPECT_EQ(outcome("fault_stop"), "fault_stop");
}

TEST(Metrics, APathDrawnHalfwayLeavesNoPlannedLength) {
  RunRecord run = straight_run(10.0);
  run.global_paths.push_back({50.0, 2, false, false, {{4.5, 0.0}, {10.0, 3.0}}, {}});
  for (const bool arrives : {true, false}) {
    if (!arrives) run.states.pop_back();
    const Metrics m = figures(run);
    for (const double figure : {m.planned_length_m, m.path_ratio, m.progress}) EXPECT_TRUE(std::isnan(figure));
    EXPECT_NEAR(m.driven_length_m, 10.0, 1e-9);
    EXPECT_NEAR(m.final_error_m, 3.0, 1e-9);
  }
}

TEST(Metrics, APathSentAfterTheGoalIsNotPlanned) {
  RunRecord run = straight_run(10.0);
  run.global_paths.push_back({106.0, 2, false, false, {{10.0, 0.0}, {10.0, 30.0}}, {}});
  const Metrics m = figures(run, TrueWorld{{{10.0, 20.0, 0.2, 0.3}}, {}});
  EXPECT_NEAR(m.path_ratio, 1.0, 1e-9);
  EXPECT_NEAR(m.progress, 0.5, 1e-9);
  EXPECT_NEAR(m.final_error_m, 0.0, 1e-9);
  EXPECT_EQ(m.rocks_encountered, 0);
}

TEST(Metrics, ReplansOfARestartedPlannerAddUp) {
  RunRecord run = straight_run(10.0);
  run.planner = {{10.0, false, false, 1}, {20.0, false, false, 3}, {30.0, false, false, 0}, {40.0, false, false, 2}};
  EXPECT_EQ(figures(run).replans, 5);
  EXPECT_NEAR(figures(run).replans_per_m, 0.5, 1e-9);
}

TEST(Metrics, CrossTrackCountsWhileFollowingOnly) {
  RunRecord run = straight_run(10.0);
  for (ControlSample& control : run.control) control.cross_track_m = control.t_s < 55.0 ? 0.3 : -0.4;
  for (ControlSample& control : run.control)
    if (control.t_s > 100.0) control = {control.t_s, Following::kPointTurn, 1, 9.0};
  const Metrics m = figures(run);
  EXPECT_NEAR(m.cross_track_max_m, 0.4, 1e-12);
  // 100 samples from 5 s and 91 from 55 s to 100 s.
  EXPECT_NEAR(m.cross_track_rms_m, std::sqrt((100 * 0.09 + 91 * 0.16) / 191), 1e-9);
  EXPECT_NEAR(m.point_turn_s, 5.0, 0.51);
}

TEST(Metrics, DeviationIsTruthAgainstTheFollowedPathInMap) {
  RunRecord run = straight_run(10.0);
  for (TruthSample& truth : run.truth)
    if (truth.t_s > 50.0) truth.T_map_body.translation().y() = 0.7;
  EXPECT_NEAR(figures(run).truth_deviation_max_m, 0.7, 1e-9);
  // A local path in odom, shifted as the truth is, leaves nothing of it.
  run.local_paths = {{50.0, 2, true, true, {{0.0, 0.0}, {20.0, 0.0}}}};
  for (ControlSample& control : run.control)
    if (control.t_s > 50.0) control.path_id = 2;
  for (PoseSample& pose : run.poses) pose.T_map_odom.translation().y() = pose.t_s > 50.0 ? 0.7 : 0.0;
  EXPECT_NEAR(figures(run).truth_deviation_max_m, 0.0, 1e-9);
}

TEST(Metrics, FinalPoseIsAtOutcomeNotAtEndOfLog) {
  RunRecord run = straight_run(10.0);
  for (TruthSample& truth : run.truth)
    if (truth.t_s > 105.0) truth.T_map_body.translation().x() = 99.0;
  EXPECT_NEAR(figures(run).final_truth_pose->translation().x(), 10.0, 1e-9);
  EXPECT_NEAR(figures(run).driven_length_m, 10.0, 1e-9);
}

TEST(Metrics, HazardStopsAndLevels) {
  RunRecord run = straight_run(10.0);
  run.states = {{0.0, State::kStandby, false, ""},     {5.0, State::kDriving, false, ""},
                {30.0, State::kHazardStop, false, ""}, {40.0, State::kDriving, true, "segment"},
                {60.0, State::kHazardStop, true, ""},  {105.0, State::kGoalReached, true, ""}};
  const Metrics m = figures(run);
  EXPECT_EQ(m.hazard_stops, 2);
  ASSERT_EQ(m.level_switches.size(), 1u);
  EXPECT_TRUE(m.level_switches[0].to_full);
  EXPECT_EQ(m.level_switches[0].reason, "segment");
  EXPECT_DOUBLE_EQ(m.time_in_state_s.at("HAZARD_STOP"), 55.0);
}

TEST(Metrics, CorrectionErrorUsesTruthAtMapTime) {
  RunRecord run = straight_run(10.0);
  const double released_s = 57.0;
  for (PoseSample& pose : run.poses) pose.T_map_odom.translation().y() = pose.t_s < released_s ? 2.0 : 0.4;
  run.corrections = {{55.0, true, {0.0, 0.1, 0.0}, released_s}, {60.0, false, {0.0, 5.0, 0.0}, 60.5}};
  const Metrics m = figures(run);
  ASSERT_EQ(m.global_corrections.size(), 2u);
  EXPECT_NEAR(m.global_corrections[0].before_m, 2.0, 1e-9);
  EXPECT_NEAR(m.global_corrections[0].after_m, 0.4, 1e-9) << "what localization made of the fix";
  EXPECT_NEAR(m.global_corrections[0].correction_error_m, 0.1, 1e-9);
  EXPECT_NEAR(m.global_corrections[1].after_m, 0.4, 1e-9);
  EXPECT_TRUE(std::isnan(m.global_corrections[1].correction_error_m));
}

TEST(Metrics, ServiceMetricsSumOverRestarts) {
  RunRecord run = straight_run(10.0);
  ServiceRecord& stereo = run.services["stereo"];
  stereo.cpu_s_of_boot = {{1, 3.0}, {2, 2.0}};
  stereo.gaps = {{{1, "LOCCAM_LEFT"}, 2}, {{2, "LOCCAM_LEFT"}, 1}};
  stereo.heartbeats = {{20.0, 1, 1.0, 30.0}, {90.0, 2, 2.0, 41.0}, {100.0, 2, 2.0, 40.0}};
  const Metrics m = figures(run);
  EXPECT_DOUBLE_EQ(m.services.at("stereo").rss_first_half_mb, 30.0);
  EXPECT_DOUBLE_EQ(m.services.at("stereo").rss_mb, 41.0);
  EXPECT_DOUBLE_EQ(m.services.at("stereo").cpu_s, 5.0);
  EXPECT_NEAR(m.services.at("stereo").cpu_s_per_m, 0.5, 1e-9);
  EXPECT_EQ(m.services.at("stereo").restarts, 1);
  EXPECT_EQ(m.bus_lost, 3);
}

TEST(Metrics, RocksOfTheWorldAreCounted) {
  RunRecord run = straight_run(10.0);
  run.hazards = {hazard_at(25.0, 3.0, 0.9)};
  const TrueWorld world{{{5.0, 0.9, 0.15, 0.25}, {7.0, 0.0, 0.1, 0.22}, {5.0, 4.0, 0.2, 0.3}, {6.0, 0.0, 0.1, 0.1}},
                        {}};
  const Metrics m = figures(run, world);
  EXPECT_EQ(m.rocks_encountered, 2);
  EXPECT_EQ(m.rocks_detected, 1);
  EXPECT_EQ(m.rocks_missed, 1);
  EXPECT_EQ(m.false_stops, 0);
}

}  // namespace
}  // namespace rover::report
