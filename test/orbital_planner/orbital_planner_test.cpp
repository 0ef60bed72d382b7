// Plans on maps with known solutions.
#include "tools/orbital_planner/orbital_planner.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "map_fixture.hpp"

namespace rover::orbital {
namespace {

Plan plan(const ElevationRaster& map, const Line& waypoints, const PlannerConfig& config) {
  return orbital::plan(analyse(map, config.terrain), waypoints, config);
}

// A ridge from south to north at x = 60 m, 6 m high, too steep to climb; it ends at y = 75 m.
double ridge(double x, double y) {
  const double along = std::clamp((80.0 - y) / 5.0, 0.0, 1.0);
  return 6.0 * along * std::exp(-0.5 * std::pow((x - 60.0) / 5.0, 2));
}

double far_north(const Plan& plan) {
  double most = 0.0;
  for (const Eigen::Vector2d& p : plan.line) most = std::max(most, p.y());
  return most;
}

double largest_slope_deg(const Plan& plan) {
  double most = 0.0;
  for (const PathSegment& s : plan.segments) most = std::max(most, to_deg(s.max_slope_rad));
  return most;
}

// Properties of every plan.
void expect_sound(const Plan& plan, const Line& waypoints, const PlannerConfig& config) {
  ASSERT_EQ(plan.status, PlanStatus::kPlanned);
  EXPECT_EQ(plan.line.front(), waypoints.front());
  EXPECT_EQ(plan.line.back(), waypoints.back());
  ASSERT_EQ(plan.level.size(), plan.line.size());
  ASSERT_EQ(plan.difficulty.size(), plan.line.size());
  EXPECT_TRUE(std::isfinite(plan.cost_m));
  const CostMap costs = travel_cost(plan.terrain, config.cost);
  for (size_t i = 1; i < plan.line.size(); ++i) EXPECT_TRUE(is_open(costs.grid, plan.line[i - 1], plan.line[i])) << i;
  double length = 0.0;
  size_t at = 0;
  for (const PathSegment& s : plan.segments) {
    EXPECT_EQ(s.first, at);
    for (size_t i = s.first; i < s.last; ++i) EXPECT_EQ(plan.level[i], s.level);
    length += s.length_m;
    at = s.last;
  }
  EXPECT_EQ(at + 1, plan.line.size());
  EXPECT_NEAR(length, plan.length_m, 1e-6);
}

TEST(OrbitalPlanner, PlansAroundSteepRidge) {
  const Line waypoints{{20, 30}, {100, 30}};
  const Plan result = plan(map_of(120, 100, 1.0, ridge), waypoints, {});
  expect_sound(result, waypoints, {});
  EXPECT_GT(far_north(result), 75.0);
  EXPECT_LT(largest_slope_deg(result), 15.0);
  // Around the end of the ridge with clearance, but no detour.
  EXPECT_LT(far_north(result), 92.0);
  EXPECT_LT(result.length_m, 155.0);
}

TEST(OrbitalPlanner, CrossesAGentleRidge) {
  const Line waypoints{{20, 30}, {100, 30}};
  const Plan result = plan(map_of(120, 100, 1.0, [](double x, double y) { return 0.1 * ridge(x, y); }), waypoints, {});
  expect_sound(result, waypoints, {});
  EXPECT_LT(far_north(result), 40.0);
  EXPECT_EQ(result.segments.size(), 1u);
  EXPECT_EQ(result.segments[0].level, Level::kEfficient);
}

TEST(OrbitalPlanner, PassesStepAtItsGap) {
  // 0.8 m high along x = 50 m, a ramp of 20 m length between y = 60 and 80 m.
  const auto step = [](double x, double y) {
    return y > 60 && y < 80 ? 0.8 * std::clamp((x - 40.0) / 20.0, 0.0, 1.0) : (x > 50 ? 0.8 : 0.0);
  };
  const Line waypoints{{20, 30}, {80, 30}};
  const Plan result = plan(map_of(100, 100, 1.0, step), waypoints, {});
  expect_sound(result, waypoints, {});
  for (size_t i = 1; i < result.line.size(); ++i)
    if ((result.line[i].x() > 50) != (result.line[i - 1].x() > 50)) {
      EXPECT_GT(result.line[i].y(), 62.0);
      EXPECT_LT(result.line[i].y(), 78.0);
    }
}

TEST(OrbitalPlanner, KeepsClearanceFromVoids) {
  const auto hole = [](double x, double y) { return std::hypot(x - 50, y - 40) < 15.0 ? kVoid : 2.0F; };
  const Line waypoints{{15, 40}, {85, 40}};
  const Plan result = plan(map_of(100, 80, 1.0, hole), waypoints, {});
  expect_sound(result, waypoints, {});
  for (const Eigen::Vector2d& p : result.line) EXPECT_GT((p - Eigen::Vector2d(50, 40)).norm(), 15.0 + 2.0);
}

TEST(OrbitalPlanner, HardTerrainOnPathIsFull) {
  // A slope of 12 deg across the whole map between x = 60 and 110 m.
  const double g = std::tan(to_rad(12.0));
  const auto slope = [g](double x, double) { return g * std::clamp(x - 60.0, 0.0, 50.0); };
  const Line waypoints{{15, 30}, {165, 30}};
  const Plan result = plan(map_of(180, 60, 1.0, slope), waypoints, {});
  expect_sound(result, waypoints, {});
  ASSERT_EQ(result.segments.size(), 3u);
  EXPECT_EQ(result.segments[0].level, Level::kEfficient);
  EXPECT_EQ(result.segments[1].level, Level::kFull);
  EXPECT_EQ(result.segments[2].level, Level::kEfficient);
  EXPECT_NEAR(result.line[result.segments[1].first].x(), 57.0, 4.0);
  EXPECT_NEAR(result.line[result.segments[1].last].x(), 111.0, 4.0);
  EXPECT_NEAR(to_deg(result.segments[1].max_slope_rad), 12.0, 0.1);
}

TEST(OrbitalPlanner, WaypointsArePassedInTheirOrder) {
  const Line waypoints{{10, 10}, {80, 15}, {20, 70}, {85, 85}};
  const Plan result = plan(level_map(100, 100), waypoints, {});
  expect_sound(result, waypoints, {});
  size_t from = 0;
  for (const Eigen::Vector2d& w : waypoints) {
    const auto near = std::find_if(result.line.begin() + static_cast<long>(from), result.line.end(),
                                   [&](const Eigen::Vector2d& p) { return (p - w).norm() < 3.0; });
    ASSERT_NE(near, result.line.end());
    from = static_cast<size_t>(near - result.line.begin());
  }
}

TEST(OrbitalPlanner, ReportsInvalidWaypointAndReason) {
  const auto ground = [](double x, double y) {
    if (x > 70 && y > 70) return kVoid;                         // no data in the north-east corner
    if (std::abs(x - 50) < 1) return 30.0F;                     // a wall across the map
    return std::hypot(x - 20.5, y - 60.5) < 0.1 ? 3.0F : 0.0F;  // a boulder
  };
  const ElevationRaster map = map_of(100, 100, 1.0, ground);
  const auto status_of = [&](const Line& waypoints) {
    const Plan result = plan(map, waypoints, {});
    return std::pair{result.status, result.waypoint};
  };
  using S = PlanStatus;
  EXPECT_EQ(status_of({{20, 20}, {30, 30}}).first, S::kPlanned);
  EXPECT_EQ(status_of({{-0.1, 20}, {30, 30}}), std::pair(S::kOutside, size_t{0}));
  EXPECT_EQ(status_of({{20, 20}, {30, 100.1}}), std::pair(S::kOutside, size_t{1}));
  EXPECT_EQ(status_of({{20, 20}, {kNaN, 30}}), std::pair(S::kOutside, size_t{1}));
  EXPECT_EQ(status_of({{20, 20}, {85, 85}}), std::pair(S::kNoData, size_t{1}));
  EXPECT_EQ(status_of({{20, 20}, {22, 61}, {30, 30}}), std::pair(S::kNotClear, size_t{1}));
  EXPECT_EQ(status_of({{20, 20}, {80, 20}}), std::pair(S::kUnreachable, size_t{1}));
  EXPECT_EQ(status_of({{20, 20}, {30, 30}, {80, 20}}), std::pair(S::kUnreachable, size_t{2}));
  EXPECT_LT(plan(map, {{22, 61}, {30, 30}}, {}).obstacle_distance_m, 3.0);
}

TEST(OrbitalPlanner, TheSameMapGivesTheSamePlan) {
  const auto hills = [](double x, double y) { return 2.0 * std::sin(0.11 * x) * std::cos(0.07 * y + 0.02 * x); };
  const ElevationRaster map = map_of(150, 120, 1.0, hills);
  const Line waypoints{{10, 10}, {140, 110}};
  const Plan first = plan(map, waypoints, {}), second = plan(map, waypoints, {});
  expect_sound(first, waypoints, {});
  EXPECT_EQ(first.line, second.line);
  EXPECT_EQ(first.level, second.level);
  EXPECT_EQ(first.cost_m, second.cost_m);
}

TEST(OrbitalPlanner, MapResolutionChangesPathLittle) {
  const Line waypoints{{20, 30}, {100, 30}};
  const Plan coarse = plan(map_of(120, 100, 1.0, ridge), waypoints, {});
  const Plan fine = plan(map_of(240, 200, 0.5, ridge), waypoints, {});
  expect_sound(fine, waypoints, {});
  EXPECT_NEAR(fine.length_m, coarse.length_m, 0.05 * coarse.length_m);
}

}  // namespace
}  // namespace rover::orbital
