#include "tools/report/stop_evaluation.hpp"

#include <gtest/gtest.h>

#include "known_run.hpp"

namespace rover::report {
namespace {

constexpr double kRepairS = 30.0;  // the rover is at x = 2.5

// A straight run whose path is repaired at t = 30 s because of a cell 2 m ahead.
RunRecord repaired_run() {
  RunRecord run = straight_run(10.0);
  run.hazards = {hazard_at(kRepairS - 0.5, 2.0, 0.0)};
  run.local_paths = {{kRepairS, 2, true, true, {{2.5, 0.0}, {4.5, 1.0}, {8.0, 0.0}}}};
  return run;
}

std::vector<Incident> incidents(const RunRecord& run, const TrueWorld& world) {
  return evaluate_stops(run, TrueTrack(run.truth), drive_window(run), Footprint{}, world);
}

TEST(StopEvaluation, ReplanForRealRockIsNotFalse) {
  const std::vector<Incident> found = incidents(repaired_run(), {{{4.6, 0.3, 0.15, 0.2}}, {}});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].real);
  EXPECT_TRUE(found[0].replanned);
  EXPECT_FALSE(found[0].stopped);
  EXPECT_DOUBLE_EQ(found[0].tallest_rock_m, 0.2);
  EXPECT_EQ(found[0].cells.size(), 1u);
  EXPECT_EQ(found[0].new_path.size(), 3u);
}

TEST(StopEvaluation, ReplanWithoutRockIsFalse) {
  EXPECT_TRUE(incidents(repaired_run(), {})[0].is_false());
  // Too low, and too far from the cell.
  EXPECT_TRUE(incidents(repaired_run(), {{{4.6, 0.3, 0.15, 0.11}}, {}})[0].is_false());
  EXPECT_TRUE(incidents(repaired_run(), {{{4.45, 0.55, 0.15, 0.3}}, {}})[0].is_false());
}

TEST(StopEvaluation, AStepInTheGroundIsReal) {
  TrueWorld world;
  world.height_m = [](double x, double) { return x > 4.5 ? 0.3 : 0.0; };
  EXPECT_TRUE(incidents(repaired_run(), world)[0].real);
  // A slope of 20 deg is not a step.
  world.height_m = [](double x, double) { return 0.36 * x; };
  EXPECT_TRUE(incidents(repaired_run(), world)[0].is_false());
}

TEST(StopEvaluation, RockBesidePathIsNotTheCause) {
  RunRecord run = repaired_run();
  run.hazards = {hazard_at(kRepairS - 0.5, 2.0, 1.5)};
  EXPECT_TRUE(incidents(run, {{{4.45, 1.5, 0.3, 0.4}}, {}})[0].is_false());
}

TEST(StopEvaluation, AvoidedRockDoesNotJustifyReplan) {
  RunRecord run = repaired_run();
  // A rock 0.3 m beside the swept footprint, and a false detection inside it.
  run.hazards.push_back(hazard_at(kRepairS - 0.5, 2.0, 0.77));
  const TrueWorld world{{{4.45, 0.97, 0.2, 0.4}}, {}};
  EXPECT_TRUE(incidents(run, world)[0].is_false());
  // Without the false detection, the rock is within the grown margin.
  run.hazards.erase(run.hazards.begin());
  EXPECT_TRUE(incidents(run, world)[0].real);
}

TEST(StopEvaluation, UnobservedGroundIsASeparateCause) {
  RunRecord run = repaired_run();
  run.hazards.clear();
  run.planner = {{kRepairS - 0.1, false, true, 1}};
  ASSERT_EQ(incidents(run, {}).size(), 1u);
  const Incident incident = incidents(run, {})[0];
  EXPECT_TRUE(incident.unseen);
  EXPECT_FALSE(incident.is_false());
}

TEST(StopEvaluation, PathRepublishedAfterMapCorrectionIsNoIncident) {
  RunRecord run = repaired_run();
  run.planner = {{kRepairS - 1.0, false, false, 0}, {kRepairS - 0.1, false, false, 1}};
  run.local_paths.push_back({60.0, 3, true, true, {{5.0, 0.0}, {8.0, 0.0}}});
  run.planner.push_back({60.0, false, false, 1});
  ASSERT_EQ(incidents(run, {}).size(), 1u);
  EXPECT_DOUBLE_EQ(incidents(run, {})[0].t_s, kRepairS);
}

TEST(StopEvaluation, AStopAndItsRepairAreOneIncident) {
  RunRecord run = repaired_run();
  run.states = {{0.0, State::kStandby, false, ""},     {5.0, State::kDriving, false, ""},
                {28.0, State::kHazardStop, false, ""}, {29.0, State::kRepairing, false, ""},
                {31.0, State::kDriving, false, ""},    {105.0, State::kGoalReached, false, ""}};
  run.local_paths.push_back({60.0, 3, true, true, {{5.0, 0.0}, {8.0, 0.0}}});
  const std::vector<Incident> found = incidents(run, {});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_TRUE(found[0].stopped && found[0].replanned);
  EXPECT_DOUBLE_EQ(found[0].t_s, 28.0);
  EXPECT_TRUE(!found[1].stopped && found[1].replanned);
}

TEST(StopEvaluation, ALevelChangeDuringAStopIsNoSecondIncident) {
  RunRecord run = straight_run(10.0);
  run.states = {{5.0, State::kDriving, false, ""},
                {28.0, State::kHazardStop, false, ""},
                {29.0, State::kHazardStop, true, ""},
                {31.0, State::kDriving, true, ""}};
  ASSERT_EQ(incidents(run, {}).size(), 1u);
  EXPECT_DOUBLE_EQ(incidents(run, {})[0].t_s, 28.0);
}

TEST(StopEvaluation, PathsOfDriftedRoverAreShownAtTruePosition) {
  RunRecord run = repaired_run();
  // The rover's estimate is 1 m too far left, and so are its odom paths.
  for (PoseSample& pose : run.poses) pose.T_odom_body.translation().y() += 1.0;
  const Points placed = path_in_truth(run, TrueTrack(run.truth), run.local_paths[0], kRepairS);
  EXPECT_NEAR(placed[0].y(), -1.0, 1e-9);
}

}  // namespace
}  // namespace rover::report
