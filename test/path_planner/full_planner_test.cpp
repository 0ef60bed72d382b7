// Continuous planning of the Full level: the ground it knows, the fields, the plans, and when it keeps to one.
#include "path_planner/full_planner.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "test/path_planner/planner_rig.hpp"
#include "test/path_planner/rock_drive.hpp"

namespace rover::planning {
namespace {

using testing_support::drive;
using testing_support::DriveConfig;
using testing_support::DriveResult;
using testing_support::planner_config;
using testing_support::PlannerRig;
using testing_support::Rock;
using testing_support::rock_field;

constexpr double kMapSideM = 20.0;
constexpr std::uint8_t kFree = 0;

// A map about the point, each cell as `cost` says.
TraversabilityGrid map_about(Point2 center, const std::function<std::uint8_t(Point2)>& cost, Utime utime = 0) {
  const int cells = static_cast<int>(kMapSideM / 0.1);
  TraversabilityGrid map{utime, 0.1, center.x_m - 0.5 * kMapSideM, center.y_m - 0.5 * kMapSideM, cells, cells, {}};
  for (int iy = 0; iy < cells; ++iy)
    for (int ix = 0; ix < cells; ++ix)
      map.cells.push_back(cost({map.origin_x_m + (ix + 0.5) * 0.1, map.origin_y_m + (iy + 0.5) * 0.1}));
  return map;
}

std::uint8_t free_ground(Point2 /*p*/) {
  return kFree;
}

// A wall across the way at x = 4 with a gap about y = `middle`.
std::function<std::uint8_t(Point2)> wall(double middle_m, double width_m) {
  return [=](Point2 p) {
    const bool in_gap = std::abs(p.y_m - middle_m) < 0.5 * width_m;
    return std::abs(p.x_m - 4.0) < 0.15 && !in_gap ? TraversabilityGrid::kImpassable : kFree;
  };
}

// The end of a channel too narrow to turn in, 2.5 m from its mouth.
std::uint8_t channel(Point2 p) {
  const bool sides = std::abs(std::abs(p.y_m) - 0.85) < 0.1 && p.x_m > -2.5 && p.x_m < 1.4;
  const bool end = std::abs(p.x_m - 1.3) < 0.1 && std::abs(p.y_m) < 0.95;
  return sides || end ? TraversabilityGrid::kImpassable : kFree;
}

struct Ground {
  HazardMemory memory{planner_config().memory};
  GroundMap map{280, 0.1, 3.0};
  Route global{{{{-3.0, 0.0}}, {{30.0, 0.0}}}};
  std::vector<DeadEnd> dead_ends;

  explicit Ground(const std::function<std::uint8_t(Point2)>& cost) {
    memory.move_to({0.0, 0.0});
    map.move_to({0.0, 0.0});
    map.add(map_about({0.0, 0.0}, cost), {0.0, 0.0});
  }

  FullRequest request(const Terrain& terrain, const Pose2& rover = {}) const {
    FullRequest out{.terrain = &terrain,
                    .footprint = planner_config().footprint,
                    .view = planner_config().repair.view,
                    .global = global,
                    .from_m = rover.x_m + 3.0,
                    .rover = rover,
                    .start = rover,
                    .stopped = rover,
                    .held = {},
                    .dead_ends = dead_ends};
    out.roomy_margin_m = 0.17;
    out.tight_margin_m = 0.11;
    out.squeeze_margin_m = 0.11;
    out.turn_margin_m = 0.15;
    out.goal_reach_m = 0.3;
    return out;
  }

  FullPlan plan(const Pose2& rover = {}) const {
    const Terrain terrain(memory, &map, Terrain::Reach::kGround);
    return FullPlanner(planner_config().full).plan(request(terrain, rover));
  }
};

double length_of(const std::vector<Pose2>& poses) {
  double sum = 0.0;
  for (size_t i = 1; i < poses.size(); ++i) sum += distance(position(poses[i - 1]), position(poses[i]));
  return sum;
}

double y_at(const std::vector<Pose2>& poses, double x_m) {
  for (const Pose2& pose : poses)
    if (pose.x_m >= x_m) return pose.y_m;
  return kNaN;
}

TEST(TraversabilityGrid, SaysWhyItIsNotUsable) {
  const TraversabilityGrid good = map_about({0.0, 0.0}, free_ground);
  EXPECT_EQ(good.fault(), "");
  std::vector<TraversabilityGrid> bad(6, good);
  bad[0].cells.pop_back();
  bad[1].cell_m = kNaN;
  bad[2].origin_x_m = kNaN;
  bad[3].origin_y_m = kInfinity;
  bad[4].cells_x = -200;
  bad[5].cells_x = bad[5].cells_y = 30000;
  for (size_t i = 0; i < bad.size(); ++i) EXPECT_NE(bad[i].fault(), "") << i;
}

TEST(TraversabilityGrid, OutsideNothingIsKnown) {
  const TraversabilityGrid map = map_about({5.0, -3.0}, [](Point2 p) { return p.x_m > 5.0 ? kFree : 77; });
  EXPECT_EQ(map.at({5.05, -3.0}), kFree);
  EXPECT_EQ(map.at({4.95, -3.0}), 77);
  EXPECT_EQ(map.at({15.1, -3.0}), TraversabilityGrid::kUnknown);
  EXPECT_EQ(map.at({kNaN, -3.0}), TraversabilityGrid::kUnknown);
}

TEST(GroundMap, RemembersWhatTheNewestMapDoesNotKnowAndForgetsWhatItLeaves) {
  GroundMap map(280, 0.1, 3.0);
  map.move_to({0.0, 0.0});
  map.add(map_about({0.0, 0.0}, [](Point2) { return std::uint8_t{100}; }), {0.0, 0.0});
  map.add(map_about({0.0, 0.0}, [](Point2 p) { return p.x_m > 0.0 ? std::uint8_t{7} : TraversabilityGrid::kUnknown; }),
          {0.0, 0.0});
  const auto at = [&](double x, double y) { return map.map().get(map.map().index_of(x, y)).cost; };
  EXPECT_EQ(at(-1.0, 0.0), 100);
  EXPECT_EQ(at(1.0, 0.0), 7);
  EXPECT_EQ(at(12.0, 0.0), TraversabilityGrid::kUnknown);
  map.move_to({8.0, 0.0});
  EXPECT_EQ(at(-5.0, 0.0), 100);
  EXPECT_EQ(at(-7.0, 0.0), TraversabilityGrid::kUnknown);
}

// One cell, seen from a range.
struct LookedAtCell {
  GroundMap map{280, 0.1, 3.0};
  LookedAtCell() { map.move_to({0.0, 0.0}); }
  std::uint8_t look(std::uint8_t cost, double range_m) {
    map.add(map_about({0.0, 0.0}, [=](Point2) { return cost; }), {5.05 - range_m, 0.05});
    return map.map().get(map.map().index_of(5.05, 0.05)).cost;
  }
};

// Found closed from 4 m, a gap looked open again from 8 m, and the rover went to and fro.
TEST(GroundMap, AMapFromAfarDoesNotChangeWhatWasSeenFromNear) {
  LookedAtCell cell;
  EXPECT_EQ(cell.look(50, 8.0), 50);
  EXPECT_EQ(cell.look(254, 4.0), 254);
  EXPECT_EQ(cell.look(50, 8.0), 254);
  EXPECT_EQ(cell.look(60, 2.0), 60);
  EXPECT_EQ(cell.look(254, 8.0), 60);
  EXPECT_EQ(cell.look(254, 2.9), 254);  // from so near each counts
  EXPECT_EQ(cell.look(254, 1.0), 254);
  EXPECT_EQ(cell.look(70, 3.5), 254);
}

// Cells at the rim of a rock are closed by one map and opened by the next from the same place, and the gap beside them
// with them.
TEST(GroundMap, AClosedCellIsOpenedFromClearlyNearerOnly) {
  LookedAtCell cell;
  EXPECT_EQ(cell.look(50, 6.0), 50);
  EXPECT_EQ(cell.look(254, 6.0), 254);
  EXPECT_EQ(cell.look(60, 6.0), 254);
  EXPECT_EQ(cell.look(60, 5.2), 254);
  EXPECT_EQ(cell.look(60, 5.0), 60);
  EXPECT_EQ(cell.look(254, 4.0), 254);
  EXPECT_EQ(cell.look(70, 3.5), 254);
  EXPECT_EQ(cell.look(70, 3.3), 70);
  EXPECT_EQ(cell.look(254, 3.3), 254);
  EXPECT_EQ(cell.look(70, 3.3), 254);
  cell.map.doubt_closed();
  EXPECT_EQ(cell.look(70, 3.3), 70) << "no way is left, and one map may have been wrong";
}

TEST(GroundMap, KeepsWhatTheLocCamIsSureOfWhereItsMemoryEnds) {
  Ground ground([](Point2 p) { return distance(p, {2.05, 0.05}) < 0.15 ? TraversabilityGrid::kImpassable : kFree; });
  const auto cell = [&](double x) -> GroundCell& {
    return ground.memory.map().at(ground.memory.map().index_of(x, 0.05));
  };
  cell(2.05).near_free = static_cast<std::uint8_t>(planner_config().memory.sure_free);
  cell(3.05).hits = 2;
  cell(4.05).hits = 1;
  ground.map.add(ground.memory);
  ground.memory.clear();
  ground.map.add(map_about({0.0, 0.0}, [](Point2) { return std::uint8_t{253}; }), {-3.0, 0.05});
  const auto at = [&](double x) { return ground.map.map().get(ground.map.map().index_of(x, 0.05)).cost; };
  EXPECT_EQ(at(2.05), TraversabilityGrid::kRefuted);
  EXPECT_EQ(at(3.05), TraversabilityGrid::kImpassable);
  EXPECT_EQ(at(4.05), kFree);
}

TEST(UnitedTerrain, TheMapsRocksAreHazardsUnlessTheRoverDroveOverThemAndKnownGroundIsSeen) {
  Ground ground([](Point2 p) {
    const bool rock = distance(p, {3.0, 0.0}) < 0.2 || distance(p, {0.0, 0.0}) < 0.2;
    return p.x_m > 6.0 ? TraversabilityGrid::kUnknown : rock ? TraversabilityGrid::kImpassable : kFree;
  });
  ground.memory.mark_driven({}, planner_config().footprint);
  const Terrain terrain(ground.memory, &ground.map, Terrain::Reach::kGround);
  EXPECT_LT(terrain.hazard_distance_m(Point2{3.05, 0.05}), 0.1);
  EXPECT_GT(terrain.hazard_distance_m(Point2{0.05, 0.05}), 2.0);
  EXPECT_FALSE(terrain.unseen(Point2{5.5, 0.05}));
  EXPECT_TRUE(terrain.unseen(Point2{6.5, 0.05}));
  EXPECT_TRUE(
      std::all_of(terrain.hazards().begin(), terrain.hazards().end(), [](const auto& h) { return h.confirmed; }));
  EXPECT_TRUE(Terrain(ground.memory).hazards().empty());
}

// What Efficient knows stands although the map says otherwise.
TEST(UnitedTerrain, AHazardStandsAgainstAFreeMap) {
  Ground ground(free_ground);
  ground.memory.map().at(ground.memory.map().index_of(3.05, 0.05)) = {.seen = true, .hits = 3};
  const Terrain terrain(ground.memory, &ground.map, Terrain::Reach::kGround);
  ASSERT_EQ(terrain.hazards().size(), 1u);
  EXPECT_TRUE(terrain.hazards().front().confirmed);
}

// From near the LocCam sees better than the NavCam from afar, where it sees the ground free again and again.
TEST(UnitedTerrain, WhatTheLocCamSeesFreeFromNearRefutesTheMap) {
  Ground ground([](Point2 p) { return distance(p, {2.05, 0.05}) < 0.15 ? TraversabilityGrid::kImpassable : kFree; });
  std::mt19937_64 random(1);
  const auto hazards = [&] { return Terrain(ground.memory, &ground.map, Terrain::Reach::kGround).hazards().size(); };
  const auto look = [&](const std::vector<Rock>& rocks) {
    ground.memory.add(testing_support::observe({}, rocks, {}, 0, random), Eigen::Isometry3d::Identity(), 0.0);
  };
  ASSERT_GT(hazards(), 0u);
  const int frames = planner_config().memory.sure_free;
  for (int i = 0; i + 1 < frames; ++i) look({});
  EXPECT_GT(hazards(), 0u);
  look({{{2.05, 0.05}, 0.2, 0.3}});  // after all
  for (int i = 0; i + 1 < frames; ++i) look({});
  EXPECT_GT(hazards(), 0u);
  for (int i = 0; i < 10; ++i) look({});
  EXPECT_EQ(hazards(), 0u);
}

// The rover backs without looking: ground that the LocCam never saw free is not driven on in doubt.
TEST(UnitedTerrain, InDoubtOnTheWayBackOnlySpotsThatTheLocCamSawFreeDoNotCount) {
  Ground ground([](Point2 p) {
    return distance(p, {-1.05, 0.05}) < 0.06 || distance(p, {-2.05, 0.05}) < 0.06 ? TraversabilityGrid::kImpassable
                                                                                  : kFree;
  });
  ground.memory.map().at(ground.memory.map().index_of(-1.05, 0.05)) = {.seen = true, .near_free = 1};
  const Terrain terrain(ground.memory, &ground.map, Terrain::Reach::kGround, {{0.0, 0.0}, 0.0, 8, true});
  EXPECT_GT(terrain.hazard_distance_m(Point2{-1.05, 0.05}), 0.15);
  EXPECT_LT(terrain.hazard_distance_m(Point2{-2.05, 0.05}), 0.15);
}

// Two spots in the map, near and far, and a rock.
TEST(UnitedTerrain, InDoubtSmallSpotsFarFromTheRoverDoNotCountUnlessTheLocCamConfirmsThem) {
  Ground ground([](Point2 p) {
    const bool spot =
        distance(p, {1.0, 1.5}) < 0.12 || distance(p, {5.0, 1.5}) < 0.12 || distance(p, {5.0, -1.5}) < 0.12;
    return spot || distance(p, {6.0, 0.0}) < 0.4 ? TraversabilityGrid::kImpassable : kFree;
  });
  ground.memory.map().at(ground.memory.map().index_of(5.05, -1.55)) = {.seen = true, .hits = 1};
  const Terrain terrain(ground.memory, &ground.map, Terrain::Reach::kGround, {{0.0, 0.0}, 2.0, 8});
  const auto hazard = [&](double x, double y) { return terrain.hazard_distance_m(Point2{x, y}) < 0.15; };
  EXPECT_FALSE(hazard(5.0, 1.5));
  EXPECT_TRUE(hazard(1.0, 1.5));
  EXPECT_TRUE(hazard(5.0, -1.5));
  EXPECT_TRUE(hazard(6.0, 0.0));
  EXPECT_GT(terrain.difficulty(terrain.cell_of({5.05, 1.55})), 0.9);
}

TEST(HeadingField, PricesDistanceTurnsAndGaps) {
  const auto to_go = [](const std::function<std::uint8_t(Point2)>& cost, const Pose2& pose) {
    const Ground ground(cost);
    const Terrain terrain(ground.memory, &ground.map, Terrain::Reach::kGround);
    const GoalField goal(planner_config().full.goal,
                         {terrain, ground.global, 3.0, {0.0, 0.0}, 0.47, 0.11, 0.3, ground.dead_ends});
    return HeadingField(planner_config().full.search,
                        {terrain, goal, planner_config().footprint, pose, 0.17, 0.15, 0.11, 0.03})
        .to_go(pose);
  };
  EXPECT_NEAR(to_go(free_ground, {}), 8.0, 0.7);
  EXPECT_NEAR(to_go(free_ground, {0.0, 0.0, kPi / 2}), 8.0, 2.0);                // on an arc
  EXPECT_GT(to_go(free_ground, {0.0, 0.0, kPi}), to_go(free_ground, {}) + 3.0);  // a half circle, or a point turn
  EXPECT_LT(to_go(free_ground, {0.0, 0.0, kPi}), to_go(free_ground, {}) + 3.0 + kPi + 0.5);
  EXPECT_LT(to_go(wall(0.0, 2.0), {}), 9.5);
  EXPECT_LT(to_go(wall(0.0, 1.4), {}), 13.0);  // at the price of the tight margin
  EXPECT_TRUE(std::isinf(to_go(wall(0.0, 1.0), {})) || to_go(wall(0.0, 1.0), {}) > 20.0);
}

// Laid towards the rover only, it tells of the way there what it would tell if laid everywhere.
TEST(HeadingField, IsLaidWhereWaysFromTheRoverLead) {
  const Ground ground(free_ground);
  const Terrain terrain(ground.memory, &ground.map, Terrain::Reach::kGround);
  const auto laid_for = [&](Point2 rover) {
    const GoalField goal(
        planner_config().full.goal,
        {terrain, ground.global, 3.0, rover, planner_config().footprint.half_width_m, 0.11, 0.3, ground.dead_ends});
    const HeadingField field(
        planner_config().full.search,
        {terrain, goal, planner_config().footprint, {rover.x_m, rover.y_m, 0.0}, 0.17, 0.15, 0.11, 0.11});
    return std::tuple(field.to_go({0.0, 0.0, 0.0}), field.to_go({2.0, 0.5, 0.3}), field.to_go({2.0, -9.0, 0.0}),
                      field.settled());
  };
  const auto [here, onward, aside, settled] = laid_for({0.0, 0.0});
  EXPECT_TRUE(std::isinf(aside));
  const auto [here_too, onward_too, aside_too, more] = laid_for({-1.0, -1.5});
  EXPECT_LT(settled, more);
  EXPECT_NEAR(here, here_too, 1e-6);
  EXPECT_NEAR(onward, onward_too, 1e-6);
  EXPECT_LT(8 * settled, terrain.cells() * terrain.cells() * 3 * HeadingField::kHeadings);
}

TEST(FullPlanner, OverFreeGroundThePlanIsStraight) {
  const FullPlan plan = Ground(free_ground).plan();
  ASSERT_TRUE(plan.plan.found);
  EXPECT_FALSE(plan.held);
  EXPECT_EQ(plan.plan.halts, 0);
  EXPECT_GE(plan.plan.poses.back().x_m, 8.0);
  EXPECT_NEAR(length_of(plan.plan.poses), plan.plan.poses.back().x_m, 0.02);
  EXPECT_LT(plan.plan.expansions, 100);
}

TEST(FullPlanner, ThroughAGapWithinCurvatureAndMargin) {
  for (const double middle : {-2.5, -1.0, 0.6, 2.2}) {
    const Ground ground(wall(middle, 1.7));
    const FullPlan plan = ground.plan();
    ASSERT_TRUE(plan.plan.found) << middle;
    EXPECT_NEAR(y_at(plan.plan.poses, 4.0), middle, 0.4);
    const Terrain terrain(ground.memory, &ground.map, Terrain::Reach::kGround);
    const FootprintCheck check(terrain, planner_config().footprint, 0.11, 0.0, {});
    for (const Pose2& pose : plan.plan.poses) EXPECT_TRUE(check.clear(pose));
    for (size_t i = 1; i < plan.plan.poses.size(); ++i) {
      const double step = distance(position(plan.plan.poses[i - 1]), position(plan.plan.poses[i]));
      if (step < 1e-6) continue;  // a point turn
      EXPECT_LE(std::abs(plan.plan.poses[i].yaw_rad - plan.plan.poses[i - 1].yaw_rad), 0.8 * step + 1e-9);
    }
  }
}

// A gap that only the tight margin fits through is taken where the way round is long, and left where it is short.
TEST(FullPlanner, ATightGapIsWeighedAgainstTheWayRound) {
  const auto two_gaps = [](double other_m) {
    return [=](Point2 p) {
      const bool gap = std::abs(p.y_m - 0.05) < 0.59 || std::abs(p.y_m - other_m) < 1.5;
      return std::abs(p.x_m - 4.0) < 0.15 && !gap ? TraversabilityGrid::kImpassable : kFree;
    };
  };
  const FullPlan direct = Ground(two_gaps(6.5)).plan();
  ASSERT_TRUE(direct.plan.found);
  EXPECT_NEAR(y_at(direct.plan.poses, 4.0), 0.0, 0.3);
  const FullPlan round = Ground(two_gaps(2.4)).plan();
  ASSERT_TRUE(round.plan.found);
  EXPECT_GT(y_at(round.plan.poses, 4.0), 0.8);
}

// One that only the least margin fits through, likewise: 8 cm to the cells' centres on both sides.
TEST(FullPlanner, AGapForTheLeastMarginIsDearNotClosed) {
  const auto plan = [](double other_m, double squeeze_m) {
    const Ground ground([=](Point2 p) {
      const bool gap = std::abs(p.y_m) < 0.52 || std::abs(p.y_m - other_m) < 1.5;
      return std::abs(p.x_m - 4.0) < 0.15 && !gap ? TraversabilityGrid::kImpassable : kFree;
    });
    const Terrain terrain(ground.memory, &ground.map, Terrain::Reach::kGround);
    FullRequest request = ground.request(terrain);
    request.squeeze_margin_m = squeeze_m;
    return FullPlanner(planner_config().full).plan(request);
  };
  EXPECT_NEAR(y_at(plan(9.0, 0.06).plan.poses, 4.0), 0.0, 0.05);
  EXPECT_GT(y_at(plan(3.0, 0.06).plan.poses, 4.0), 0.8);
  EXPECT_FALSE(std::abs(y_at(plan(9.0, 0.11).plan.poses, 4.0)) < 0.5);
}

TEST(FullPlanner, EnclosedThereIsNoPlan) {
  const FullPlan plan = Ground([](Point2 p) {
                          const double r = distance(p, {0.0, 0.0});
                          return r > 2.0 && r < 2.3 ? TraversabilityGrid::kImpassable : kFree;
                        }).plan();
  EXPECT_FALSE(plan.plan.found);
}

TEST(FullPlanner, OutOfADeadEndItBacksToWhereAWayLeadsOn) {
  const Ground ground(channel);
  const Terrain terrain(ground.memory, &ground.map, Terrain::Reach::kGround);
  FullRequest request = ground.request(terrain);
  request.may_back = false;
  EXPECT_FALSE(FullPlanner(planner_config().full).plan(request).plan.found);
  const CurvePlan plan = ground.plan().plan;
  ASSERT_TRUE(plan.found);
  EXPECT_TRUE(plan.backs_first);
  ASSERT_EQ(plan.reversals.size(), 1U);
  EXPECT_LT(plan.poses[plan.reversals.front()].x_m, -2.5);
  EXPECT_GT(plan.poses.back().x_m, 7.5);
  const FootprintCheck check(terrain, planner_config().footprint, 0.11, 0.0, {});
  EXPECT_TRUE(std::all_of(plan.poses.begin(), plan.poses.end(), [&](const Pose2& p) { return check.clear(p); }));
}

TEST(FullPlanner, OverUnseenGroundItDoesNotBack) {
  EXPECT_FALSE(Ground([](Point2 p) {
                 if (p.x_m < -1.0) return TraversabilityGrid::kUnknown;
                 return p.x_m > 1.2 && p.x_m < 1.4 ? TraversabilityGrid::kImpassable : kFree;
               })
                   .plan()
                   .plan.found);
}

// Where ahead and astern change, each leg begins at the pose at which the one before ends.
TEST(CurvePlan, FallsIntoLegs) {
  CurvePlan plan;
  for (const double x : {0.0, -0.1, -0.2, -0.1, 0.0, 0.1}) plan.poses.push_back({x, 0.0, 0.0});
  plan.backs_first = true;
  plan.reversals = {2};
  const std::deque<CurveLeg> legs = legs_of(plan);
  ASSERT_EQ(legs.size(), 2U);
  EXPECT_TRUE(legs[0].backwards);
  EXPECT_FALSE(legs[1].backwards);
  EXPECT_EQ(legs[0].poses.size(), 3U);
  EXPECT_EQ(legs[1].poses.size(), 4U);
  EXPECT_EQ(legs[1].poses.front().x_m, -0.2);
}

// A wall across all of the map, of which one side ends near the global path: beyond it there may be a way around.
TEST(FullPlanner, WhereTheMapIsClosedAWayLeadsOutOfIt) {
  const auto wall = [](Point2 p) { return std::abs(p.x_m - 5.0) < 0.2 ? TraversabilityGrid::kImpassable : kFree; };
  Ground ground(wall);
  for (const double y : {-5.0, 5.0}) ground.map.add(map_about({0.0, y}, wall), {0.0, y});
  ground.global = Route({{{-3.0, -7.0}}, {{10.0, -7.0}}});
  const Terrain terrain(ground.memory, &ground.map, Terrain::Reach::kGround);
  FullRequest request = ground.request(terrain);
  const FullPlan plan = FullPlanner(planner_config().full).plan(request);
  ASSERT_TRUE(plan.plan.found);
  EXPECT_LT(plan.plan.poses.back().y_m, -13.0);
  EXPECT_LT(plan.plan.poses.back().x_m, 5.0);
  request.from_m = 6.0;  // the goal is in sight
  EXPECT_FALSE(FullPlanner(planner_config().full).plan(request).plan.found);
}

// Where there is room: a stone that is passable would come under a wheel, beside the rover's centre line.
TEST(FullPlanner, StonesThatMayBeDrivenOverAreDrivenAround) {
  const auto stone = [](Point2 p) { return distance(p, {4.0, 0.35}) < 0.15 ? std::uint8_t{200} : kFree; };
  const FullPlan plan = Ground(stone).plan();
  ASSERT_TRUE(plan.plan.found);
  EXPECT_LT(y_at(plan.plan.poses, 4.0), -0.1);
}

// Where the ground ahead shows rocks that may prove hazards from near, the way around is taken though it is
// longer.
TEST(FullPlanner, RocksThatMayProveHazardsFromNearCostMoreThanSlopesDo) {
  const auto way = [](std::uint8_t cost) {
    const auto stones = [cost](Point2 p) {
      if (p.x_m < 3.0 || p.x_m > 5.0 || p.y_m > 3.0) return kFree;
      return p.y_m > -2.0 ? cost : TraversabilityGrid::kImpassable;
    };
    return y_at(Ground(stones).plan().plan.poses, 4.0);
  };
  EXPECT_LT(way(170), 0.5);  // 15 deg
  EXPECT_GT(way(250), 3.2);
}

// A gap that was found closed is weighed against the way round.
TEST(FullPlanner, ADeadEndCostsWhatItIsTold) {
  const auto two_gaps = [](Point2 p) {
    const bool gap = std::abs(p.y_m) < 1.0 || std::abs(p.y_m - 6.0) < 1.0;
    return std::abs(p.x_m - 4.0) < 0.15 && !gap ? TraversabilityGrid::kImpassable : kFree;
  };
  Ground ground(two_gaps);
  ground.dead_ends = {{{4.0, 0.0}, 1.0}};
  EXPECT_NEAR(y_at(ground.plan().plan.poses, 4.0), 0.0, 0.6);
  ground.dead_ends = {{{4.0, 0.0}, 10.0}};
  EXPECT_NEAR(y_at(ground.plan().plan.poses, 4.0), 6.0, 0.6);
}

// Ground beside the rover that no camera has seen is not driven on; ground further ahead is, for there the cameras come
// first.
TEST(FullPlanner, UnknownGroundNearbyIsNotEnteredFurtherOnItCostsMore) {
  const FullPlan far = Ground([](Point2 p) { return p.x_m > 4.0 ? TraversabilityGrid::kUnknown : kFree; }).plan();
  EXPECT_TRUE(far.plan.found);
  const FullPlan near = Ground([](Point2 p) {
                          return std::abs(p.x_m) < 1.0 && std::abs(p.y_m) < 0.6 ? kFree : TraversabilityGrid::kUnknown;
                        }).plan({0.0, 0.0, kPi / 2});
  EXPECT_FALSE(near.plan.found && near.plan.poses[1].y_m > 0.0 && near.plan.halts > 0);
  EXPECT_TRUE(near.plan.unseen_in_the_way || near.plan.found);
}

// A rock right ahead, a little to the left: the way to its right is the shorter one.
std::uint8_t rock_ahead(Point2 p) {
  return distance(p, {5.0, 0.25}) < 0.6 ? TraversabilityGrid::kImpassable : kFree;
}

HeldWay held_to_the(double side) {
  HeldWay held;
  for (double s = 0.0; s <= 3.0; s += 0.05) held.poses.push_back(advanced({}, s, side * 0.12));
  held.end_curvature_per_m = side * 0.12;
  return held;
}

TEST(FullPlanner, ThePlanBeingDrivenIsHeldUnlessAnotherOneIsClearlyCheaper) {
  const Ground ground(rock_ahead);
  const Terrain terrain(ground.memory, &ground.map, Terrain::Reach::kGround);
  FullRequest request = ground.request(terrain);
  const FullPlanner planner(planner_config().full);
  EXPECT_LT(y_at(planner.plan(request).plan.poses, 5.0), 0.0);
  request.held = held_to_the(1.0);
  const FullPlan held = planner.plan(request);
  ASSERT_TRUE(held.plan.found);
  EXPECT_TRUE(held.held);
  EXPECT_NEAR(distance(position(held.plan.poses.front()), position(request.held->poses.back())), 0.0, 1e-9);
  EXPECT_GT(y_at(held.plan.poses, 5.0), 0.0);
  request.held->halts = 1;  // with a point turn in it
  request.held->turn_left_rad = kPi / 2;
  EXPECT_FALSE(planner.plan(request).held);
}

TEST(FullPlanner, ABlockedPlanIsNotHeld) {
  const Ground ground([](Point2 p) { return distance(p, {2.6, 0.4}) < 0.3 ? TraversabilityGrid::kImpassable : kFree; });
  const Terrain terrain(ground.memory, &ground.map, Terrain::Reach::kGround);
  FullRequest request = ground.request(terrain);
  request.held = held_to_the(1.0);
  const FullPlan plan = FullPlanner(planner_config().full).plan(request);
  ASSERT_TRUE(plan.plan.found);
  EXPECT_FALSE(plan.held);
}

class FullLevel : public testing::Test {
 protected:
  FullLevel() {
    rig.send_path({{0.0, 0.0}, {30.0, 0.0}});
    rig.step();
  }
  bool send_map(const std::function<std::uint8_t(Point2)>& cost) {
    return rig.planner.add_traversability(map_about(position(rig.odom), cost, rig.now));
  }
  PlannerRig rig;
};

TEST_F(FullLevel, AMapMakesAContinuousPathWhichIsNoReplanForAHazard) {
  rig.planner.set_level(true);
  ASSERT_TRUE(send_map(wall(1.2, 1.8)));
  const PlannerOutput out = rig.step();
  ASSERT_TRUE(out.path);
  EXPECT_EQ(out.path->kind, PathKind::kContinuous);
  EXPECT_EQ(out.status.state, PlannerState::kFollowing);
  EXPECT_EQ(out.status.replans, 0);
  EXPECT_TRUE(std::isinf(out.status.blocked_in_m) || out.status.blocked_in_m > 6.0);
  EXPECT_NEAR(out.path->points.back().p.x_m, 30.0, 1e-6);  // reaches to the goal
  const Route route(out.path->points);
  EXPECT_NEAR(route.point_at(route.closest({4.0, 1.2})).y_m, 1.2, 0.4);
  EXPECT_TRUE(route.kinks().empty());
}

TEST_F(FullLevel, AtTheEfficientLevelMapsChangeNothing) {
  EXPECT_FALSE(send_map(wall(1.2, 1.8)));
  EXPECT_FALSE(rig.step().path);
  EXPECT_EQ(rig.paths.size(), 1u);
}

TEST_F(FullLevel, AnUnusableMapIsRefused) {
  rig.planner.set_level(true);
  TraversabilityGrid map = map_about({0.0, 0.0}, free_ground, rig.now);
  map.cells.pop_back();
  EXPECT_FALSE(rig.planner.add_traversability(map));
  EXPECT_FALSE(rig.step().path);
}

TEST_F(FullLevel, LevelDownThePlanGoesOnAsARepairAndEndsOnTheGlobalPath) {
  rig.planner.set_level(true);
  send_map(wall(1.2, 1.8));
  rig.step();
  rig.planner.set_level(false);
  EXPECT_EQ(rig.step().status.state, PlannerState::kRepairing);
  rig.go(22.0);
  EXPECT_EQ(rig.paths.back().kind, PathKind::kGlobal);
  EXPECT_NEAR(rig.odom.y_m, 0.0, 0.1);
}

// Driving on could only lead deeper into a dead end: the rover is held long before the hazard, once that is certain,
// and backs out. One map may be wrong.
TEST_F(FullLevel, WhereByTheMapNoWayLeadsOnTheRoverStopsAndGoesBack) {
  rig.planner.set_level(true);
  send_map(free_ground);
  rig.step();
  rig.go(1.0);
  send_map(wall(0.0, 0.0));
  rig.forward_mps = 0.1;
  EXPECT_GT(rig.look(1).status.blocked_in_m, 1.0);
  const PlannerOutput stopped = rig.look(planner_config().patience_frames - 1);
  EXPECT_EQ(stopped.status.blocked_in_m, 0.0);
  EXPECT_EQ(stopped.status.block_kind, BlockKind::kHazard);
  EXPECT_NE(stopped.status.text, "");
  rig.forward_mps = 0.0;
  rig.look(1);
  EXPECT_EQ(rig.paths.back().kind, PathKind::kRetreat);
  send_map(wall(1.0, 1.8));
  rig.odom = Route(rig.paths.back().points).pose_at(100.0);
  rig.odom.yaw_rad = 0.0;
  rig.look(2);
  EXPECT_EQ(rig.paths.back().kind, PathKind::kContinuous);
}

// Spots across the way that the NavCam took for rocks: it goes up to them, for the LocCam to decide.
TEST_F(FullLevel, DoubtfulSpotsAreApproachedWhereNothingElseLeadsOn) {
  rig.planner.set_level(true);
  send_map([](Point2 p) {
    const double y = std::abs(p.y_m - std::round(p.y_m));
    return std::abs(p.x_m - 4.0) < 0.1 && y < 0.12 ? TraversabilityGrid::kImpassable : kFree;
  });
  rig.step();
  EXPECT_EQ(rig.paths.back().kind, PathKind::kContinuous);
  EXPECT_LT(rig.go(8.0).status.state, PlannerState::kNoPath);
  EXPECT_GT(rig.odom.x_m, 6.0);
}

// Makes a plan when it is told to.
class PlanOnDemand final : public PlanMaker {
 public:
  bool start(std::shared_ptr<const PlanJob> job, Utime /*now*/) override {
    newest = job_ = std::move(job);
    ++started;
    return true;
  }
  std::optional<FullPlan> result(Utime /*now*/, bool pressing) override {
    if (!job_ || !(let_go || (pressing && quick))) return std::nullopt;
    return std::exchange(job_, nullptr)->run();
  }
  std::shared_ptr<const PlanJob> newest;
  int started = 0;
  bool let_go = false;
  bool quick = false;  // for one that presses

 private:
  std::shared_ptr<const PlanJob> job_;
};

class FullLevelBeside : public testing::Test {
 protected:
  FullLevelBeside() {
    rig.planner = PathPlanner(planner_config(), 1, maker);
    rig.planner.set_start_area({0.0, 0.0}, 2.0, 0);
    rig.send_path({{0.0, 0.0}, {30.0, 0.0}});
    rig.step();
    rig.planner.set_level(true);
  }
  void send_map(const std::function<std::uint8_t(Point2)>& cost) {
    rig.planner.add_traversability(map_about(position(rig.odom), cost, rig.now));
  }
  // At speed on a plan over free ground.
  void drive_freely() {
    maker->let_go = true;
    send_map(free_ground);
    rig.step();
    rig.forward_mps = 0.2;
  }
  std::shared_ptr<PlanOnDemand> maker = std::make_shared<PlanOnDemand>();
  PlannerRig rig;
};

TEST_F(FullLevelBeside, FramesAreJudgedWhileAPlanIsBeingMadeAndItIsTakenWhenItIsThere) {
  send_map(wall(1.2, 1.8));
  rig.step();
  const size_t paths = rig.paths.size();
  rig.rocks = {{{1.6, 0.0}, 0.2, 0.3}};
  EXPECT_LT(rig.look(3).status.blocked_in_m, 1.0);
  EXPECT_EQ(maker->started, 2);  // the rock presses
  EXPECT_EQ(rig.paths.size(), paths);
  rig.rocks.clear();
  maker->let_go = true;
  EXPECT_TRUE(rig.step().path);
  EXPECT_EQ(rig.paths.back().kind, PathKind::kContinuous);
}

TEST_F(FullLevelBeside, AMovingRoverIsNotStoppedWhereAPlanIsThereInAMoment) {
  maker->quick = true;
  send_map(free_ground);
  rig.step();
  EXPECT_EQ(rig.paths.back().kind, PathKind::kGlobal);  // nothing presses
  rig.rocks = {{{1.5, -0.7}, 0.15, 0.3}};
  rig.forward_mps = 0.2;
  const PlannerOutput out = rig.look(3);
  EXPECT_EQ(rig.paths.back().kind, PathKind::kContinuous);
  EXPECT_TRUE(std::isinf(out.status.blocked_in_m));
}

// It would be one too many each time that a frame comes before it is there.
TEST_F(FullLevelBeside, APlanThatPressesIsNotBegunAnewWithEachFrame) {
  send_map(free_ground);
  rig.step();
  rig.rocks = {{{1.5, 0.0}, 0.2, 0.3}};
  rig.forward_mps = 0.2;
  rig.look(4);
  EXPECT_EQ(maker->started, 2);
}

TEST_F(FullLevelBeside, ASingleHitBesideTheWayIsDrivenPastAtOnce) {
  drive_freely();
  const size_t paths = rig.paths.size();
  rig.rocks = {{{1.5, -0.55}, 0.1, 0.3}};
  EXPECT_TRUE(std::isinf(rig.look(1).status.blocked_in_m));
  EXPECT_EQ(rig.paths.size(), paths + 1);
  EXPECT_TRUE(Route(rig.paths.back().points).kinks().empty());
}

TEST_F(FullLevelBeside, ASingleHitForWhichTheRoverWouldHaveToTurnIsLeftToTheNextFrames) {
  drive_freely();
  const size_t paths = rig.paths.size();
  rig.rocks = {{{1.2, 0.0}, 0.2, 0.3}};
  const PlannerOutput stopped = rig.look(1);
  EXPECT_EQ(maker->started, 2);
  EXPECT_LT(stopped.status.blocked_in_m, 0.5);
  EXPECT_EQ(stopped.status.state, PlannerState::kFollowing);
  rig.rocks.clear();
  EXPECT_TRUE(std::isinf(rig.look(2).status.blocked_in_m));
  EXPECT_EQ(rig.paths.size(), paths);
}

TEST_F(FullLevelBeside, WhereTheBlockIsNearerThanTheRoverCanHaltAPlanBendsAwayAtOnce) {
  const auto start_x_m = [&](double rock_x_m) {
    rig.rocks = {{{rock_x_m, 0.0}, 0.2, 0.3}};
    rig.look(4);
    return maker->newest->request().start.x_m;
  };
  rig.forward_mps = 0.2;
  send_map(free_ground);
  maker->let_go = true;
  EXPECT_NEAR(start_x_m(2.6), 0.24, 0.01);
  EXPECT_NEAR(maker->newest->request().stopped.x_m, 0.24, 0.01);
  EXPECT_NEAR(start_x_m(1.2), 0.04, 0.01);
  EXPECT_NEAR(maker->newest->request().stopped.x_m, 0.24, 0.01);
}

TEST_F(FullLevelBeside, WhatComesMeanwhileIsPlannedForNext) {
  send_map(free_ground);
  rig.step();
  send_map(wall(1.2, 1.8));
  rig.step();
  EXPECT_EQ(maker->started, 1);
  maker->let_go = true;
  rig.step();
  EXPECT_EQ(maker->started, 2);
  rig.step();
  const Route route(rig.paths.back().points);
  EXPECT_NEAR(route.point_at(route.closest({4.0, 1.2})).y_m, 1.2, 0.4);
}

// Else what blocks the ways to it comes and goes with the rover.
TEST_F(FullLevelBeside, TheGoalLineStaysWhereItWasWhenTheRoverComesBack) {
  maker->let_go = true;
  send_map(free_ground);
  rig.step();
  rig.go(3.0);
  send_map(free_ground);
  rig.step();
  const std::shared_ptr<const PlanJob> job_ahead = maker->newest;
  const FullRequest& ahead = job_ahead->request();
  EXPECT_EQ(ahead.back_m, 0.0);
  rig.odom.x_m -= 0.7;
  send_map(free_ground);
  rig.step();
  const FullRequest& back = maker->newest->request();
  EXPECT_NEAR(back.back_m, 0.7, 0.01);
  EXPECT_NEAR(back.from_m + back.back_m, ahead.from_m, 1e-6);
  const Terrain terrain(rig.planner.memory());
  const auto past_line_m = [&](const FullRequest& request) {
    return GoalField(planner_config().full.goal, {terrain, request.global, request.from_m, position(request.rover),
                                                  0.47, 0.11, 0.3, request.dead_ends, request.back_m})
        .past_line_m({5.0, 0.0});
  };
  EXPECT_NEAR(past_line_m(back), past_line_m(ahead), 0.3);
}

TEST_F(FullLevelBeside, APlanForAnotherPathIsOfNoUse) {
  send_map(wall(1.2, 1.8));
  rig.step();
  rig.send_path({{0.0, 0.0}, {0.0, 30.0}}, 8);
  maker->let_go = true;
  rig.step();
  EXPECT_TRUE(std::none_of(rig.paths.begin(), rig.paths.end(),
                           [](const LocalPath& p) { return p.kind == PathKind::kContinuous; }));
  rig.step();
  EXPECT_NEAR(Route(rig.paths.back().points).point_at(5.0).x_m, 0.0, 1.5);
}

// In a channel in which it cannot turn, and of which the map does not show the mouth.
TEST_F(FullLevel, WhereThereIsNoRoomToTurnTheRoverGoesStraightBack) {
  rig.planner.set_level(true);
  send_map(free_ground);
  rig.step();
  rig.go(3.0);
  rig.odom = {rig.odom.x_m, rig.odom.y_m + 3.0, -1.2};
  rig.planner.set_level(false);  // forgets the free map
  rig.planner.set_level(true);
  const Pose2 there = rig.odom;
  for (const double y : {-0.75, 0.0, 0.75}) {
    const double c = std::cos(there.yaw_rad), sn = std::sin(there.yaw_rad);
    rig.rocks.push_back({{there.x_m + c * 1.2 - sn * y, there.y_m + sn * 1.2 + c * y}, 0.2, 0.3});
  }
  send_map([&](Point2 p) {
    const Point2 b = to_body(there, p);
    const bool ahead = std::abs(b.x_m - 1.2) < 0.1, aside = std::abs(std::abs(b.y_m) - 0.7) < 0.1 && b.x_m > -12.0;
    return ahead || aside ? TraversabilityGrid::kImpassable : kFree;
  });
  rig.look(planner_config().patience_frames + 1);
  ASSERT_EQ(rig.paths.back().kind, PathKind::kRetreat);
  const Point2 end = to_body(there, rig.paths.back().points.back().p);
  EXPECT_LT(end.x_m, -0.5);
  EXPECT_NEAR(end.y_m, 0.0, 0.05);
}

// On a slope the rover drives with its nose aside of its track. Back on it, the stern would meet the rock before the
// rover has come onto the track's heading: that way was begun and stopped again and again.
TEST(FullPlanner, AWayBackOnWhichTheRoverWouldBeStoppedIsNone) {
  const auto ways_back = [](double rock_aside_m) {
    PlannerRig rig;
    rig.send_path({{0.0, 0.0}, {30.0, 0.0}});
    rig.step();
    rig.planner.set_level(true);
    rig.planner.add_traversability(map_about(position(rig.odom), free_ground, rig.now));
    rig.step();
    for (; rig.odom.x_m < 3.0; rig.odom.x_m += 0.05) rig.step();  // without a frame that tells what is beside the track
    rig.planner.set_level(false);                                 // forgets the free map
    rig.planner.set_level(true);
    const Point2 there = position(rig.odom);
    rig.odom.yaw_rad = -0.2;
    for (const double y : {-0.75, -0.25, 0.25}) rig.rocks.push_back({{there.x_m + 1.2, there.y_m + y}, 0.2, 0.3});
    const auto channel_with_a_rock = [&](Point2 p) {
      const double x = p.x_m - there.x_m, y = p.y_m - there.y_m;
      const bool wall = std::abs(x - 1.2) < 0.1 || (std::abs(std::abs(y) - 0.9) < 0.1 && x > -12.0);
      const bool rock = std::hypot(x + 0.95, y - rock_aside_m) < 0.08;
      return wall || rock ? TraversabilityGrid::kImpassable : kFree;
    };
    rig.planner.add_traversability(map_about(there, channel_with_a_rock, rig.now));
    rig.look(planner_config().patience_frames + 2);
    return std::count_if(rig.paths.begin(), rig.paths.end(),
                         [](const LocalPath& p) { return p.kind == PathKind::kRetreat; });
  };
  EXPECT_EQ(ways_back(0.6), 0);
  EXPECT_EQ(ways_back(0.8), 1);
}

// A rock close behind, no track to go back on, and no way ahead.
TEST_F(FullLevel, WhereNothingLeadsStraightBackTheRoverTurnsFirst) {
  rig.planner.set_level(true);
  send_map(free_ground);
  rig.step();
  send_map([](Point2 p) {
    const bool enclosed = std::abs(std::hypot(p.x_m, p.y_m) - 2.7) < 0.2;
    return enclosed || std::hypot(p.x_m + 1.1, p.y_m - 0.25) < 0.1 ? TraversabilityGrid::kImpassable : kFree;
  });
  rig.look(planner_config().patience_frames + 2);
  ASSERT_EQ(rig.paths.back().kind, PathKind::kRetreat);
  const Point2 end = rig.paths.back().points.back().p;
  EXPECT_GT(std::hypot(end.x_m, end.y_m), 0.5);
  EXPECT_LT(end.x_m, -0.1);
  EXPECT_LT(end.y_m, -0.4);  // away from the rock
  rig.forward_mps = -0.1;
  EXPECT_TRUE(std::isinf(rig.look(1).status.blocked_in_m));
}

// A PATH astern, then one ahead; each begins where the rover is, and none but the last leads to the goal.
TEST_F(FullLevel, APlanThatBacksIsDrivenLegByLeg) {
  rig.planner.set_level(true);
  send_map(channel);
  PlannerOutput out = rig.step();
  ASSERT_TRUE(out.path);
  EXPECT_EQ(out.path->kind, PathKind::kRetreat);
  EXPECT_LT(distance(out.path->points.front().p, position(rig.odom)), 0.1);
  EXPECT_GT(out.status.goal_distance_m, 25.0);
  const Route back(out.path->points);
  for (double s = 0.0; s <= back.length_m(); s += 0.05) {
    rig.odom = back.pose_at(s);
    rig.odom.yaw_rad += kPi;
    rig.forward_mps = -0.2;
    EXPECT_FALSE(rig.look().path);
  }
  EXPECT_LT(rig.odom.x_m, -2.5);
  rig.forward_mps = 0.0;
  out = rig.look();
  ASSERT_TRUE(out.path);
  EXPECT_EQ(out.path->kind, PathKind::kContinuous);
  EXPECT_LT(distance(out.path->points.front().p, position(rig.odom)), 0.15);
  EXPECT_NEAR(out.path->points.back().p.x_m, 30.0, 1e-6);
}

// Nothing looks astern but the map: the ground is judged from where the rover is, not from where its path is.
TEST_F(FullLevel, ABackingRoverOffItsPathIsStoppedBeforeAHazard) {
  rig.planner.set_level(true);
  send_map(channel);
  rig.step();
  ASSERT_EQ(rig.paths.back().kind, PathKind::kRetreat);
  rig.forward_mps = -0.2;
  rig.odom.x_m = -0.3;
  EXPECT_TRUE(std::isinf(rig.look().status.blocked_in_m));
  rig.odom.y_m = 0.21;
  rig.odom.yaw_rad = -0.1;  // and further aside
  EXPECT_LT(rig.look().status.blocked_in_m, 0.5);
}

// From near the gap is closed, from afar it looks open again: the rover does not turn back for it.
TEST_F(FullLevel, AGapThatWasFoundClosedIsNotTriedAgainFromAfar) {
  const auto gaps = [](bool near_open) {
    return [=](Point2 p) {
      const bool gap = (near_open && std::abs(p.y_m) < 1.0) || std::abs(p.y_m - 6.0) < 1.5;
      return std::abs(p.x_m - 4.0) < 0.15 && !gap ? TraversabilityGrid::kImpassable : kFree;
    };
  };
  const auto y_at_wall = [&] {
    for (const RoutePoint& point : rig.paths.back().points)
      if (point.p.x_m >= 4.0) return point.p.y_m;
    return kNaN;
  };
  rig.planner.set_level(true);
  send_map(gaps(true));
  rig.step();
  rig.go(0.5);
  EXPECT_NEAR(y_at_wall(), 0.0, 0.6);
  send_map(gaps(false));
  rig.look(1);
  EXPECT_NEAR(y_at_wall(), 6.0, 1.2);
  send_map(gaps(true));
  rig.look(1);
  EXPECT_NEAR(y_at_wall(), 6.0, 1.2) << "the gap that was closed looks open again";
}

// Plans are chosen by cost: what the rover takes instead may be shorter, and still the gap is not worth another try.
TEST_F(FullLevelBeside, AGapThatWasFoundClosedIsRememberedThoughTheOtherWayIsShorter) {
  maker->let_go = true;
  const auto gaps = [](bool wide_open) {
    return [=](Point2 p) {
      const bool gap = (wide_open && std::abs(p.y_m - 3.0) < 1.5) || std::abs(p.y_m - 0.05) < 0.52;
      return std::abs(p.x_m - 4.0) < 0.15 && !gap ? TraversabilityGrid::kImpassable : kFree;
    };
  };
  const auto y_at_wall = [&] {
    const Route route(rig.paths.back().points);
    for (double s = 0.0; s < route.length_m(); s += 0.05)
      if (route.point_at(s).x_m >= 4.0) return route.point_at(s).y_m;
    return kNaN;
  };
  send_map(gaps(true));
  rig.step();
  rig.go(1.0);
  const double y_of_gap = y_at_wall();
  EXPECT_GT(y_of_gap, 1.5);
  send_map(gaps(false));
  rig.look(1);
  EXPECT_NEAR(y_at_wall(), 0.05, 0.3);
  send_map(gaps(false));
  rig.look(1);
  const std::vector<DeadEnd>& closed = maker->newest->request().dead_ends;
  ASSERT_EQ(closed.size(), 1u);
  EXPECT_LT(distance(closed.front().p, {4.0, y_of_gap}), 1.5);
  EXPECT_GE(closed.front().cost_per_m, planner_config().repair.dead_end_cost);
}

// The track that a retreat leads over lies in odom: when map moves it stays what it is, and free.
TEST_F(FullLevel, ACorrectionOfTheMapLeavesARetreatAlone) {
  rig.planner.set_level(true);
  send_map(free_ground);
  rig.step();
  rig.go(1.0);
  send_map(wall(0.0, 0.0));
  rig.look(planner_config().patience_frames + 1);
  ASSERT_EQ(rig.paths.back().kind, PathKind::kRetreat);
  const size_t paths = rig.paths.size();
  rig.T_map_odom = {0.4, 0.3, 0.02};
  EXPECT_TRUE(std::isinf(rig.step().status.blocked_in_m));
  EXPECT_EQ(rig.paths.size(), paths);
}

// Nothing else is near, but a rock lies on the goal.
TEST_F(FullLevel, AGoalUnderARockIsReachedBesideIt) {
  rig.send_path({{0.0, 0.0}, {6.0, 0.0}});
  rig.planner.set_level(true);
  const auto rock = [](Point2 p) { return distance(p, {6.0, 0.0}) < 0.35 ? TraversabilityGrid::kImpassable : kFree; };
  rig.rocks = {{{6.0, 0.0}, 0.35, 0.4}};
  rig.step();
  for (int i = 0; i < 60 && rig.look().status.goal_distance_m > 0.2; ++i) {
    send_map(rock);
    rig.go(0.5);
  }
  EXPECT_LT(rig.look().status.goal_distance_m, 0.2);
  EXPECT_LT(distance(position(rig.odom), {6.0, 0.0}), planner_config().blocked_goal_reach_m + 0.1);
}

// Rocks before and behind it, 0.3 m astern: what is left of the way back may give the bow room to turn.
TEST_F(FullLevel, AWayBackOfAQuarterOfAMetreIsOne) {
  rig.planner.set_level(true);
  send_map(free_ground);
  rig.step();
  send_map([](Point2 p) {
    const bool sides = std::abs(std::abs(p.y_m) - 0.8) < 0.1 && std::abs(p.x_m) < 1.5;
    const bool ends = (std::abs(p.x_m - 1.1) < 0.1 || std::abs(p.x_m + 1.25) < 0.1) && std::abs(p.y_m) < 0.9;
    return sides || ends ? TraversabilityGrid::kImpassable : kFree;
  });
  rig.look(planner_config().patience_frames + 1);
  ASSERT_EQ(rig.paths.back().kind, PathKind::kRetreat);
  const double back_m = Route(rig.paths.back().points).length_m();
  EXPECT_GE(back_m, 0.2);
  EXPECT_LE(back_m, 0.3);
}

// 16 m beside the end of the global path is not at the goal.
TEST(FullPlanner, ARoverFarBesideTheGoalDrivesToIt) {
  PathPlannerConfig config = planner_config();
  config.full.goal.max_deviation_m = 20.0;
  Ground far(free_ground);
  far.global = Route({{{-3.0, 16.0}}, {{1.0, 16.0}}});
  const Terrain terrain(far.memory, &far.map, Terrain::Reach::kGround);
  FullRequest request = far.request(terrain);
  request.from_m = 3.0;
  const FullPlan plan = FullPlanner(config.full).plan(request);
  ASSERT_TRUE(plan.plan.found);
  EXPECT_GT(plan.plan.poses.back().y_m, 11.0) << "out of the map towards the goal";
}

// On a way back, past the end of the global path and 6 m beside it, nothing of that path is left.
TEST_F(FullLevel, ARoverThatBacksBesideTheEndOfTheGlobalPathIsNotAtTheGoal) {
  rig.send_path({{0.0, 0.0}, {8.0, 0.0}});
  rig.planner.set_level(true);
  send_map(free_ground);
  rig.step();
  rig.go(1.0);
  send_map(wall(0.0, 0.0));
  rig.look(planner_config().patience_frames + 1);
  ASSERT_EQ(rig.paths.back().kind, PathKind::kRetreat);
  rig.T_map_odom = {7.0, -6.0, 0.0};
  rig.step();
  const PlannerOutput out = rig.step();
  ASSERT_EQ(rig.paths.back().kind, PathKind::kRetreat);
  EXPECT_GT(out.status.goal_distance_m, 5.5);
}

// Without a newer map the rover that drives on is led by the LocCam alone.
TEST_F(FullLevel, AStaleMapLeavesTheEfficientLevelsBehaviour) {
  rig.planner.set_level(true);
  send_map(free_ground);
  rig.step();
  rig.go(2.4);
  rig.now += to_utime(10.0);
  rig.rocks = {{{5.4, 0.1}, 0.3, 0.3}};
  rig.look(4);
  EXPECT_EQ(rig.paths.back().kind, PathKind::kRepair);
}

TEST_F(FullLevel, AStandingRoversMapDoesNotAge) {
  rig.planner.set_level(true);
  send_map(free_ground);
  rig.step();
  rig.now += to_utime(60.0);
  rig.rocks = {{{3.0, 0.1}, 0.3, 0.3}};
  rig.look(4);
  EXPECT_EQ(rig.paths.back().kind, PathKind::kContinuous);
}

TEST(FullDrive, ThroughRocksWithoutAStopOrACollisionAndTheSameAgain) {
  constexpr double length_m = 11.0;
  std::mt19937_64 random(4);
  std::vector<Rock> rocks = rock_field(0.10, {-5.0, -12.0}, {length_m + 5.0, 12.0}, 0.3, random);
  std::erase_if(rocks, [&](const Rock& r) {
    return distance(r.p, {0.0, 0.0}) < 2.0 + r.radius_m || distance(r.p, {length_m, 0.0}) < 3.0 + r.radius_m;
  });
  DriveConfig config;
  config.planner = planner_config();
  config.full = true;
  config.timeout_s = 300.0;
  const std::vector<Point2> path = {{0.0, 0.0}, {length_m, 0.0}};
  const DriveResult a = drive(config, rocks, path, 4);
  EXPECT_TRUE(a.reached) << a.text;
  EXPECT_FALSE(a.collided);
  EXPECT_EQ(a.hazard_stops, 0);
  EXPECT_GT(a.driven_m / (config.speed_mps * a.duration_s), 0.75);
  const DriveResult b = drive(config, rocks, path, 4);
  EXPECT_EQ(a.driven_m, b.driven_m);
  EXPECT_EQ(a.track.back().y_m, b.track.back().y_m);
}

}  // namespace
}  // namespace rover::planning
