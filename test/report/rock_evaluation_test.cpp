#include "tools/report/rock_evaluation.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "known_run.hpp"

namespace rover::report {
namespace {

std::vector<RockResult> results(const RunRecord& run, const std::vector<Rock>& rocks) {
  return evaluate_rocks(run, TrueTrack(run.truth), drive_window(run), Footprint{}, rocks);
}

// On the path, 5 m from the start; the front reaches its rim at x = 5 - 0.2 - 0.875.
constexpr Rock kInTheWay{5.0, 0.0, 0.2, 0.25};
constexpr double kSweptS = 5.0 + (5.0 - 0.2 - 0.875) / 0.1;

TEST(RockEvaluation, UndetectedRockUnderFootprintIsMissed) {
  const std::vector<RockResult> v = results(straight_run(10.0), {kInTheWay});
  ASSERT_EQ(v.size(), 1u);
  EXPECT_TRUE(v[0].missed());
  EXPECT_TRUE(v[0].encountered);
  EXPECT_NEAR(v[0].swept_s, kSweptS, 0.5);
}

TEST(RockEvaluation, RockDetectedBeforeContactIsNotMissed) {
  RunRecord run = straight_run(10.0);
  run.hazards = {hazard_at(25.0, 3.0, 0.1)};  // the rover is at x = 2
  const std::vector<RockResult> v = results(run, {kInTheWay});
  EXPECT_FALSE(v[0].missed());
  EXPECT_DOUBLE_EQ(v[0].detected_s, 25.3);
}

TEST(RockEvaluation, DetectionAfterContactIsTooLate) {
  RunRecord run = straight_run(10.0);
  run.hazards = {hazard_at(kSweptS - 0.1, 1.1, 0.0, 1.0)};
  EXPECT_TRUE(results(run, {kInTheWay})[0].missed());
}

TEST(RockEvaluation, CellWithin25cmOfRimDetectsRock) {
  for (const auto& [aside, missed] : {std::pair{0.44, false}, std::pair{0.46, true}}) {
    RunRecord run = straight_run(10.0);
    run.hazards = {hazard_at(25.0, 3.0, aside)};
    EXPECT_EQ(results(run, {kInTheWay})[0].missed(), missed) << aside;
  }
}

TEST(RockEvaluation, OnlyTallRocksUnderTheFootprintCount) {
  Rock low = kInTheWay;
  low.height_m = 0.19;
  Rock beside = kInTheWay;
  beside.y_m = 0.47 + 0.2 + 0.01;
  Rock touched = kInTheWay;
  touched.y_m = 0.47 + 0.2 - 0.01;
  const std::vector<RockResult> v = results(straight_run(10.0), {low, beside, touched});
  EXPECT_FALSE(v[0].missed());
  EXPECT_LT(v[0].swept_s, kInfinity);
  EXPECT_FALSE(v[1].missed());
  EXPECT_TRUE(v[1].encountered);
  EXPECT_TRUE(v[2].missed());
  Rock pebble = kInTheWay;
  pebble.height_m = 0.149;
  EXPECT_TRUE(results(straight_run(10.0), {pebble}).empty());
}

TEST(RockEvaluation, PointTurnSweepsFootprintCorners) {
  RunRecord run = straight_run(2.0);
  // A point turn at the goal, before GOAL_REACHED.
  run.states.back().t_s = 60.0;
  for (double t = 31.0; t <= 60.0; t += 0.1) {
    TruthSample sample;
    sample.t_s = t;
    sample.T_map_body = pose_at(2.0, 0.0, (t - 31.0) * 0.1);
    run.truth.push_back(sample);
  }
  const Rock at_the_side{2.0, 0.85, 0.1, 0.3};
  EXPECT_LT(results(run, {at_the_side})[0].swept_s, 60.0);
  EXPECT_EQ(results(straight_run(2.0), {at_the_side})[0].swept_s, kInfinity);
}

TEST(RockEvaluation, TiltedRoverCellsAreProjectedToGround) {
  // Nose up by 10 deg: a cell 2 m ahead in the body's plane with the ground 0.62 m below it.
  const Eigen::Isometry3d T = make_pose(rotation_from_rpy(0.0, -to_rad(10.0), 0.0), {0.0, 0.0, 0.62});
  const Eigen::Vector2d p = cell_in_map({{2.0, 0.0}, false}, T, 0.62);
  EXPECT_NEAR(p.x(), 2.0 * std::cos(to_rad(10.0)) + 0.62 * std::sin(to_rad(10.0)), 1e-12);
}

TEST(RockEvaluation, RocksFromTheMinimumHeightOnAreHazards) {
  const std::vector<Rock> hazards = hazards_of({{1.0, 0.0, 0.2, 0.149}, {2.0, 0.0, 0.2, 0.15}, {3.0, 0.0, 0.2, 0.4}});
  ASSERT_EQ(hazards.size(), 2u);
  EXPECT_EQ(hazards[0].x_m, 2.0);
}

TEST(RockIndex, MatchesBruteForceSearch) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-20.0, 20.0);
  std::uniform_real_distribution<double> size(0.05, 0.7);
  std::vector<Rock> rocks;
  for (int i = 0; i < 500; ++i) rocks.push_back({place(random), place(random), size(random), 0.2});
  const RockIndex index(rocks);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector2d p(place(random), place(random));
    const double radius = size(random);
    std::set<size_t> expected;
    for (size_t k = 0; k < rocks.size(); ++k)
      if (std::hypot(rocks[k].x_m - p.x(), rocks[k].y_m - p.y()) <= rocks[k].radius_m + radius) expected.insert(k);
    const std::vector<size_t> found = index.near(p, radius);
    EXPECT_EQ(std::set<size_t>(found.begin(), found.end()), expected);
  }
}

}  // namespace
}  // namespace rover::report
