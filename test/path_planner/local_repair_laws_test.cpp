// Laws that every local repair keeps, on 1000 random fields of rocks, and two oracles: where a disc around the whole
// rover gets through there is a repair, where a disc inside of it does not there is none.
#include <gtest/gtest.h>

#include <queue>

#include "common/core/distance_field.hpp"
#include "test/path_planner/repair_field.hpp"

namespace rover::planning {
namespace {

using testing_support::kRepairGoalReachM;
using testing_support::kRepairMarginM;
using testing_support::plan_on;
using testing_support::planner_config;
using testing_support::random_field;
using testing_support::RepairField;

constexpr int kFields = 1000;
constexpr double kMostDetourM = 9.0;      // about twice the way without rocks
constexpr double kRoomToJoinM = 1.2;      // an arc comes in from the side within about this way
constexpr double kHaltM = 0.011;          // sections meet within the smoother's end tolerance
constexpr double kRelaxM = 0.02;          // of hazards that stand nearer than the margin at the start
constexpr double kBetweenPosesM = 0.005;  // lost between two poses that are 5 cm apart

// Few expansions: the laws hold for whatever is found, and fields without a way end sooner.
LocalRepairConfig quick_config() {
  LocalRepairConfig config = planner_config().repair;
  config.search.max_expansions = 500;
  return config;
}

struct Case {
  RepairField field;
  Terrain terrain;
  RepairResult result;
};

const std::vector<Case>& cases() {
  static const std::vector<Case> all = [] {
    std::vector<Case> out;
    for (int seed = 1; seed <= kFields; ++seed) {
      RepairField field = random_field(static_cast<std::uint64_t>(seed));
      Terrain terrain(field.memory);
      RepairResult result = plan_on(field, terrain, quick_config());
      out.push_back({std::move(field), std::move(terrain), std::move(result)});
    }
    return out;
  }();
  return all;
}

// Calls f(case) for every field with a repair; traces the seed.
template <class F>
void for_each_found(F&& f) {
  for (size_t i = 0; i < cases().size(); ++i) {
    if (cases()[i].result.status != RepairStatus::kFound) continue;
    SCOPED_TRACE("seed " + std::to_string(i + 1));
    f(cases()[i]);
    if (testing::Test::HasFatalFailure()) return;
  }
}

bool is_halt(const Pose2& a, const Pose2& b) {
  return distance(position(a), position(b)) <= kHaltM && std::abs(wrap_angle(b.yaw_rad - a.yaw_rad)) > 0.3;
}

double brute_clearance_m(const Footprint& f, const Pose2& pose, Point2 hazard) {
  const Point2 b = to_body(pose, hazard);
  const double ox = std::max(std::abs(b.x_m) - f.half_length_m, 0.0);
  const double oy = std::max(std::abs(b.y_m) - f.half_width_m, 0.0);
  const double inside = std::max(std::abs(b.x_m) - f.half_length_m, std::abs(b.y_m) - f.half_width_m);
  return inside < 0.0 ? inside : std::hypot(ox, oy);
}

TEST(LocalRepairLaws, TheFieldsAreWorthTheName) {
  int found = 0;
  int smoothed = 0;
  int halts = 0;
  int moving = 0;
  int near_goal = 0;
  for_each_found([&](const Case& c) {
    ++found;
    smoothed += c.result.smoothed ? 1 : 0;
    halts += c.result.turns_first || c.result.halts > 0 ? 1 : 0;
    moving += c.field.stopped.x_m != c.field.start.x_m ? 1 : 0;
    near_goal += c.field.route.length_m() < 12.0 ? 1 : 0;
  });
  RecordProperty("found", found);
  RecordProperty("smoothed", smoothed);
  EXPECT_GT(found, kFields / 2);
  EXPECT_LT(found, kFields);
  EXPECT_GT(smoothed, found / 2);
  EXPECT_LT(smoothed, found);
  EXPECT_GT(halts, 20);
  EXPECT_GT(moving, found / 4);
  EXPECT_GT(near_goal, found / 20);
}

TEST(LocalRepairLaws, WithoutAWayThereAreNoPosesButAReason) {
  for (const Case& c : cases()) {
    if (c.result.status == RepairStatus::kFound) continue;
    EXPECT_TRUE(c.result.poses.empty());
    EXPECT_STRNE(text_of(c.result.status), "");
    EXPECT_STRNE(text_of(c.result.status), text_of(RepairStatus::kFound));
  }
}

TEST(LocalRepairLaws, StartsAtTheRover) {
  for_each_found([](const Case& c) {
    const Pose2& first = c.result.poses.front();
    if (c.result.turns_first) {
      EXPECT_NEAR(distance(position(first), position(c.field.stopped)), 0.0, 1e-9);
    } else {
      EXPECT_NEAR(distance(position(first), position(c.field.start)), 0.0, 1e-9);
      EXPECT_NEAR(wrap_angle(first.yaw_rad - c.field.start.yaw_rad), 0.0, 1e-9);
    }
  });
}

// Forward on arcs, but for the halts. Smoothed ways are arcs between the steps of their integration, 0.5 % off.
TEST(LocalRepairLaws, DrivesForwardAndKeepsTheCurvatureBound) {
  const LocalRepairConfig config = quick_config();
  for_each_found([&](const Case& c) {
    const double most = c.result.smoothed ? config.smoother.max_curvature_per_m : config.search.max_curvature_per_m;
    int halts = 0;
    for (size_t i = 1; i < c.result.poses.size(); ++i) {
      const Pose2& a = c.result.poses[i - 1];
      const Pose2& b = c.result.poses[i];
      if (is_halt(a, b)) {
        ++halts;
        continue;
      }
      const Point2 step = to_body(a, position(b));
      const double turn = wrap_angle(b.yaw_rad - a.yaw_rad);
      ASSERT_LE(std::abs(turn), 1.005 * most * std::hypot(step.x_m, step.y_m) + 1e-9) << i;
      ASSERT_NEAR(std::atan2(step.y_m, step.x_m), 0.5 * turn, 1e-3) << i;
      ASSERT_LE(step.x_m, 0.0501);
    }
    EXPECT_EQ(halts, c.result.halts);
  });
}

TEST(LocalRepairLaws, NeverBringsTheRectangleNearerToAHazardThanTheMargin) {
  const Footprint footprint = quick_config().footprint;
  for_each_found([&](const Case& c) {
    double least = kInfinity;
    for (size_t i = 0; i + 1 < c.result.poses.size(); ++i)
      for (const double u : {0.0, 0.5}) {
        const Pose2& a = c.result.poses[i];
        const Pose2& b = c.result.poses[i + 1];
        const Pose2 pose{a.x_m + u * (b.x_m - a.x_m), a.y_m + u * (b.y_m - a.y_m),
                         a.yaw_rad + u * (b.yaw_rad - a.yaw_rad)};
        for (const HazardSpot& hazard : c.terrain.hazards()) {
          if (std::abs(hazard.p.x_m - pose.x_m) > 1.5 || std::abs(hazard.p.y_m - pose.y_m) > 1.5) continue;
          const double d = brute_clearance_m(footprint, pose, hazard.p);
          const double at_start = brute_clearance_m(footprint, c.field.start, hazard.p);
          const double allowed = std::min(kRepairMarginM, std::max(at_start - kRelaxM, 0.0));
          ASSERT_GE(d, allowed - (u > 0.0 ? kBetweenPosesM : 1e-9)) << "pose " << i;
          if (u == 0.0) least = std::min(least, d);
        }
      }
    EXPECT_LE(c.result.clearance_m, least + 1e-9);
  });
}

// The rectangle is clear all through a point turn, not only at its ends.
TEST(LocalRepairLaws, PointTurnsSweepNoHazard) {
  const Footprint footprint = quick_config().footprint;
  int turns = 0;
  const auto check_turn = [&](const Case& c, const Pose2& from, const Pose2& to) {
    ++turns;
    for (int k = 0; k <= 100; ++k) {
      const Pose2 pose{to.x_m, to.y_m, from.yaw_rad + (to.yaw_rad - from.yaw_rad) * k / 100.0};
      for (const HazardSpot& hazard : c.terrain.hazards())
        ASSERT_GE(brute_clearance_m(footprint, pose, hazard.p), kRepairMarginM - kBetweenPosesM);
    }
  };
  for_each_found([&](const Case& c) {
    if (c.result.turns_first) check_turn(c, c.field.stopped, c.result.poses.front());
    for (size_t i = 1; i < c.result.poses.size(); ++i)
      if (is_halt(c.result.poses[i - 1], c.result.poses[i])) check_turn(c, c.result.poses[i - 1], c.result.poses[i]);
  });
  EXPECT_GT(turns, 20);
}

TEST(LocalRepairLaws, EndsOnTheGlobalPathWithItsHeadingOrAtTheGoal) {
  int at_goal = 0;
  for_each_found([&](const Case& c) {
    const Pose2& last = c.result.poses.back();
    const Pose2 join = c.field.route.pose_at(c.result.join_m);
    const double off = distance(position(last), position(join));
    if (off <= 0.0101) {
      EXPECT_NEAR(wrap_angle(last.yaw_rad - join.yaw_rad), 0.0, 0.0101);
      return;
    }
    ++at_goal;
    EXPECT_NEAR(c.result.join_m, c.field.route.length_m(), 1e-9);
    EXPECT_LE(off, kRepairGoalReachM);
  });
  EXPECT_GT(at_goal, 5);
}

// From the join on, as far as the map reaches, the rover can follow the global path.
TEST(LocalRepairLaws, JoinsBeyondEveryKnownBlockage) {
  const Footprint footprint = quick_config().footprint;
  for_each_found([&](const Case& c) {
    const Route& route = c.field.route;
    for (double s = c.result.join_m; s < route.length_m() && c.terrain.inside_m(route.point_at(s)) > 0.6; s += 0.1)
      for (const HazardSpot& hazard : c.terrain.hazards())
        ASSERT_GE(brute_clearance_m(footprint, route.pose_at(s), hazard.p), kRepairMarginM - kBetweenPosesM) << s;
  });
}

TEST(LocalRepairLaws, StaysWithinTheDeviationAndTheMap) {
  LocalRepairConfig narrow = quick_config();
  narrow.max_deviation_m = 1.5;
  int found = 0;
  for (int seed = 1; seed <= 150; ++seed) {
    const RepairField field = random_field(static_cast<std::uint64_t>(seed));
    const Terrain terrain(field.memory);
    const RepairResult result = plan_on(field, terrain, narrow);
    found += result.status == RepairStatus::kFound ? 1 : 0;
    for (const Pose2& pose : result.poses) {
      const double off = distance(field.route.point_at(field.route.closest(position(pose))), position(pose));
      ASSERT_LE(off, narrow.max_deviation_m + 0.25) << seed;  // cells, and what smoothing moves
      ASSERT_GT(terrain.inside_m(position(pose)), 0.0) << seed;
    }
  }
  EXPECT_GT(found, 30);
}

std::vector<Point2> unseen_cells(const Terrain& terrain) {
  std::vector<Point2> out;
  for (int cell = 0; cell < terrain.cells() * terrain.cells(); ++cell)
    if (terrain.unseen(cell)) out.push_back(terrain.center_of(cell));
  return out;
}

// Every unseen cell that the rectangle comes to cover on the sure way was in the view from an earlier pose.
TEST(LocalRepairLaws, CoversNoGroundThatWasNotSeenInTime) {
  const LocalRepairConfig config = quick_config();
  ViewArea view = config.view;
  view.near_m -= 0.1;  // the planner looks at the rim's points, this at the centres of their cells
  view.far_m += 0.1;
  view.near_half_width_m += 0.1;
  view.far_half_width_m += 0.1;
  int partly_seen = 0;
  for_each_found([&](const Case& c) {
    if (std::isinf(c.field.sure_m)) return;
    ++partly_seen;
    const std::vector<Point2> unseen = unseen_cells(c.terrain);
    std::vector<Pose2> passed = {c.result.poses.front()};
    double way = 0.0;
    for (size_t i = 1; i < c.result.poses.size() && way < c.field.sure_m - 0.05; ++i) {
      const Pose2& pose = c.result.poses[i];
      way += distance(position(passed.back()), position(pose));
      for (const Point2& p : unseen) {
        if (brute_clearance_m(config.footprint, pose, p) > 0.0) continue;
        const auto sees = [&](const Pose2& from) { return view.sees(to_body(from, p)); };
        ASSERT_TRUE(std::any_of(passed.begin(), passed.end(), sees)) << "pose " << i << " " << p.x_m << " " << p.y_m;
      }
      for (int k = 1; k <= 8; ++k)  // a jump of the heading is a point turn that sweeps the view
        passed.push_back(
            {pose.x_m, pose.y_m, passed.back().yaw_rad + (pose.yaw_rad - passed.back().yaw_rad) * k / 8.0});
    }
  });
  EXPECT_GT(partly_seen, 50);
}

// The shortest way of a disc that keeps clear of hazards from the start to every cell, by steps to the eight
// neighbours.
class DiscReach {
 public:
  DiscReach(const Case& c, double radius_m, double most_off_path_m)
      : case_(c), radius_m_(radius_m), most_off_path_m_(most_off_path_m), off_path_m_(off_path(c)) {
    way_m_.assign(off_path_m_.size(), kInfinity);
    const int first = c.terrain.cell_of(position(c.field.start));
    if (free(first)) spread(first);
  }

  double way_m(Point2 p) const { return case_.terrain.contains(p) ? way_m_[case_.terrain.cell_of(p)] : kInfinity; }

 private:
  bool free(int cell) const {
    return case_.terrain.hazard_distance_m(cell) >= radius_m_ && off_path_m_[cell] <= most_off_path_m_;
  }

  static std::vector<double> off_path(const Case& c) {
    std::vector<std::uint8_t> path(static_cast<size_t>(c.terrain.cells()) * c.terrain.cells(), 0);
    for (double s = 0.0; s < c.field.route.length_m(); s += 0.05)
      if (const Point2 p = c.field.route.point_at(s); c.terrain.contains(p)) path[c.terrain.cell_of(p)] = 1;
    return distance_field(path, c.terrain.cells(), c.terrain.cells(), c.terrain.cell_m());
  }

  void spread(int first) {
    std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>, std::greater<>> open;
    way_m_[first] = 0.0;
    open.emplace(0.0, first);
    while (!open.empty()) {
      const auto [way, cell] = open.top();
      open.pop();
      if (way <= way_m_[cell]) step_from(cell, open);
    }
  }

  template <class Queue>
  void step_from(int cell, Queue& open) {
    const int side = case_.terrain.cells();
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const int x = cell % side + dx;
        const int y = cell / side + dy;
        if (x < 0 || y < 0 || x >= side || y >= side || !free(y * side + x)) continue;
        const double way = way_m_[cell] + case_.terrain.cell_m() * std::hypot(dx, dy);
        if (way >= way_m_[y * side + x]) continue;
        way_m_[y * side + x] = way;
        open.emplace(way, y * side + x);
      }
  }

  const Case& case_;
  double radius_m_;
  double most_off_path_m_;
  std::vector<double> off_path_m_;
  std::vector<double> way_m_;
};

// The disc's shortest way to the global path beyond `from_m`, `room_m` or more before its end or the map's border.
double way_to_the_path_m(const Case& c, const DiscReach& reach, double from_m, double room_m) {
  const Route& route = c.field.route;
  double least = kInfinity;
  for (double s = from_m; s + room_m <= route.length_m(); s += 0.1) {
    if (c.terrain.inside_m(route.point_at(s + room_m)) < 0.5) return least;
    least = std::min(least, reach.way_m(route.point_at(s)));
  }
  return std::min(least, reach.way_m(route.points().back().p));
}

// Way along the path from which on, as far as the map reaches, a disc gets along it.
double free_from_m(const Case& c, double radius_m) {
  double from = c.field.from_m + 0.5;
  const Route& route = c.field.route;
  for (double s = from; s < route.length_m() && c.terrain.inside_m(route.point_at(s)) >= 0.5; s += 0.1)
    if (c.terrain.hazard_distance_m(route.point_at(s)) < radius_m) from = s + 0.1;
  return from;
}

// A disc around the whole rover, with the margin and 0.1 m more: it could be driven by point turns and straight lines.
TEST(LocalRepairLaws, WhereTheWayIsWideARepairIsFound) {
  const LocalRepairConfig config = planner_config().repair;
  const double wide_m = config.footprint.radius_m() + kRepairMarginM + 0.1;
  int wide = 0;
  int found = 0;
  for (size_t i = 0; i < cases().size(); ++i) {
    const Case& c = cases()[i];
    const bool all_seen = std::isinf(c.field.sure_m);
    const DiscReach reach(c, wide_m, config.max_deviation_m - 0.5);
    const double way_m = way_to_the_path_m(c, reach, free_from_m(c, wide_m), kRoomToJoinM);
    if (!all_seen || way_m > kMostDetourM) continue;
    ++wide;
    const bool now =
        c.result.status == RepairStatus::kFound || plan_on(c.field, c.terrain, config).status == RepairStatus::kFound;
    found += now ? 1 : 0;
    if (!now) std::printf("no repair at seed %zu, way %.2f m\n", i + 1, way_m);
  }
  RecordProperty("wide", wide);
  RecordProperty("found", found);
  EXPECT_GT(wide, 100);
  EXPECT_GE(found, 0.97 * wide) << found << " of " << wide;
}

// A wall from border to border, with a gap.
Case walled(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  RepairField field{testing_support::ground(true), testing_support::straight_route(20.0), 4.0, {}, 0.0, {}, kInfinity};
  const double gap = testing_support::uniform(random, -1.5, 1.5);
  const double half_m = testing_support::uniform(random, 0.2, 0.8);
  std::vector<testing_support::Rock> rocks;
  for (double y = -5.0; y < 5.0; y += 0.1)
    if (std::abs(y - gap) > half_m + 0.1) rocks.push_back({{2.2, y}, 0.1, 0.3});
  testing_support::lay_rocks(field.memory, rocks);
  Terrain terrain(field.memory);
  RepairResult result = plan_on(field, terrain, quick_config());
  return {std::move(field), std::move(terrain), std::move(result)};
}

// A disc inside the rectangle, less a cell's diagonal: what it cannot pass the rover cannot.
TEST(LocalRepairLaws, WhereNothingPassesNoRepairIsInvented) {
  const Footprint footprint = quick_config().footprint;
  int closed = 0;
  int passed = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const Case c = walled(seed);
    const DiscReach reach(c, footprint.half_width_m + kRepairMarginM - 0.15, kInfinity);
    if (std::isfinite(way_to_the_path_m(c, reach, c.field.from_m + 3.0, 0.0))) {
      passed += c.result.status == RepairStatus::kFound ? 1 : 0;
      continue;
    }
    ++closed;
    EXPECT_NE(c.result.status, RepairStatus::kFound) << "seed " << seed;
  }
  EXPECT_GT(closed, 10);
  EXPECT_GT(passed, 5);
}

TEST(LocalRepairLaws, TheSameFieldGivesTheSameBytes) {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u}) {
    const RepairField field = random_field(seed);
    const RepairResult again = plan_on(field, Terrain(field.memory), quick_config());
    const RepairResult& before = cases()[seed - 1].result;
    ASSERT_EQ(again.poses.size(), before.poses.size());
    for (size_t i = 0; i < again.poses.size(); ++i) {
      EXPECT_EQ(again.poses[i].x_m, before.poses[i].x_m);
      EXPECT_EQ(again.poses[i].yaw_rad, before.poses[i].yaw_rad);
    }
  }
}

}  // namespace
}  // namespace rover::planning
