// Plans on ground of known shape, and laws that every plan keeps on random fields of rocks.
#include "path_planner/search/hybrid_planner.hpp"

#include <gtest/gtest.h>

#include "path_planner/active_path.hpp"
#include "path_planner/path_monitor.hpp"
#include "test/path_planner/plan_scene.hpp"

namespace rover::planning {
namespace {

using testing_support::certain_belief;
using testing_support::Ground;
using testing_support::ground_of;
using testing_support::GroundAt;
using testing_support::plan_request;
using testing_support::random_rocks;
using testing_support::search_config;
using testing_support::uniform;

constexpr std::uint64_t kFields = 50;
constexpr double kWallM = 4.0;
constexpr double kSamplesPerMotion = 6.0;
constexpr double kMaxMotionChange = 1.1;  // of the curvature, relative to the largest
constexpr double kKnownMarginM = 0.04;
constexpr double kApproachM = 0.005;

Ground free_ground(Point2 /*p*/) {
  return Ground::kFree;
}

Ground hazard_if(bool hazard) {
  return hazard ? Ground::kHazard : Ground::kFree;
}

struct Gap {
  double middle_m;
  double width_m;  // between the edges of hazard cells
};

// A wall across the path with gaps.
GroundAt wall(const std::vector<Gap>& gaps) {
  return [gaps](Point2 p) {
    const auto inside = [&](const Gap& gap) { return std::abs(p.y_m - gap.middle_m) < 0.5 * gap.width_m; };
    return hazard_if(std::abs(p.x_m - kWallM) < 0.15 && std::none_of(gaps.begin(), gaps.end(), inside));
  };
}

// A channel with an end ahead of the rover, `half_width_m` to each side.
GroundAt blocked_passage(double half_width_m) {
  return [=](Point2 p) {
    const bool sides = std::abs(std::abs(p.y_m) - half_width_m - 0.1) < 0.1 && p.x_m > -2.5 && p.x_m < 1.4;
    const bool end = std::abs(p.x_m - 1.3) < 0.1 && std::abs(p.y_m) < half_width_m + 0.2;
    return hazard_if(sides || end);
  };
}

Plan plan_on(const PlanRequest& request) {
  return HybridPlanner(search_config()).plan(request);
}

Plan plan_on(const GroundAt& ground) {
  return plan_on(plan_request(certain_belief(ground)));
}

double y_at(const Plan& plan, double x_m) {
  for (const PlanPose& at : plan.poses)
    if (at.pose.x_m >= x_m) return at.pose.y_m;
  return kNaN;
}

double length_of(const Plan& plan) {
  double sum = 0.0;
  for (size_t i = 1; i < plan.poses.size(); ++i)
    sum += distance(position(plan.poses[i - 1].pose), position(plan.poses[i].pose));
  return sum;
}

bool is_point_turn(const PlanPose& a, const PlanPose& b) {
  return distance(position(a.pose), position(b.pose)) < 1e-9;
}

int point_turns(const Plan& plan) {
  int turns = 0;
  for (size_t i = 1; i < plan.poses.size(); ++i) turns += is_point_turn(plan.poses[i - 1], plan.poses[i]) ? 1 : 0;
  return turns;
}

bool reverses(const Plan& plan) {
  return std::any_of(plan.poses.begin(), plan.poses.end(), [](const PlanPose& at) { return at.reverse; });
}

void expect_keeps_clearance(const Plan& plan, const PlanRequest& request) {
  const HybridPlannerConfig config = search_config();
  const auto check = [&](double margin_m) {
    return FootprintCheck(*request.costmap, config.footprint, margin_m, kApproachM, 0.0, request.rover);
  };
  const FootprintCheck min = check(config.clearances.min_m);
  const FootprintCheck turn = check(config.clearances.turn_m);
  for (size_t i = 0; i < plan.poses.size(); ++i) {
    EXPECT_TRUE(min.clear(plan.poses[i].pose)) << "pose " << i;
    if (i == 0 || !is_point_turn(plan.poses[i - 1], plan.poses[i])) continue;
    Pose2 pose = plan.poses[i - 1].pose;
    const double angle = plan.poses[i].pose.yaw_rad - pose.yaw_rad;
    for (int k = 0; k < 50; ++k, pose.yaw_rad += angle / 50.0) EXPECT_TRUE(turn.clear(pose)) << "turn at pose " << i;
  }
}

// Arcs without side slip, whose curvature is bounded and changes no faster than the steering allows.
void expect_drivable(const Plan& plan, double start_curvature_per_m = 0.0) {
  const double max_curvature = search_config().motion.max_curvature_per_m;
  const double max_change = kMaxMotionChange * max_curvature / kSamplesPerMotion;
  double last = start_curvature_per_m;
  for (size_t i = 1; i < plan.poses.size(); ++i) {
    const Pose2& from = plan.poses[i - 1].pose;
    const Pose2& to = plan.poses[i].pose;
    if (is_point_turn(plan.poses[i - 1], plan.poses[i])) {
      last = 0.0;
      continue;
    }
    const double turned = wrap_angle(to.yaw_rad - from.yaw_rad);
    const double step_m = distance(position(from), position(to));
    const Point2 moved = to_body({from.x_m, from.y_m, from.yaw_rad + 0.5 * turned}, position(to));
    EXPECT_NEAR(moved.x_m, plan.poses[i].reverse ? -step_m : step_m, 1e-9) << "pose " << i;
    EXPECT_LE(step_m, 0.0501) << "pose " << i;
    const double curvature = turned / moved.x_m;
    EXPECT_LE(std::abs(curvature), max_curvature + 1e-3) << "pose " << i;
    EXPECT_LE(std::abs(curvature - last), max_change + 1e-3) << "pose " << i;
    last = curvature;
  }
}

// Ground that the footprint comes to cover is known, or was in view before.
void expect_seen_in_time(const Plan& plan, const PlanRequest& request) {
  const HybridPlannerConfig config = search_config();
  const FootprintCheck check(*request.costmap, config.footprint, config.clearances.min_m, kApproachM, kKnownMarginM,
                             request.rover);
  Visibility visibility(*request.costmap, check, config.view);
  double forward_m = 0.0;
  for (size_t i = 0; i < plan.poses.size(); ++i) {
    const PlanPose& at = plan.poses[i];
    const Pose2 before = plan.poses[i > 0 ? i - 1 : 0].pose;
    if (!at.reverse) forward_m += distance(position(before), position(at.pose));
    if (at.reverse) {
      EXPECT_TRUE(check.known(at.pose)) << "pose " << i;
    } else if (forward_m <= HybridAStarConfig::kMinKnownFreeM) {
      EXPECT_TRUE(visibility.covers(at.pose)) << "pose " << i;
    }
    const double turned = at.pose.yaw_rad - before.yaw_rad;
    for (int k = 1; k <= 8 && i > 0; ++k)  // a point turn sweeps the view
      visibility.add_view({at.pose.x_m, at.pose.y_m, before.yaw_rad + turned * k / 8.0});
  }
}

struct PlannedField {
  std::string name;
  PlanRequest request;
  Plan plan;
};

// The random fields on which a plan is found, from different headings and curvatures.
const std::vector<PlannedField>& planned_fields() {
  static const std::vector<PlannedField> fields = [] {
    std::vector<PlannedField> out;
    for (std::uint64_t seed = 1; seed <= kFields; ++seed) {
      std::mt19937_64 random(seed);
      const Pose2 start{0.0, 0.0, uniform(random, -1.0, 1.0)};
      PlanRequest request = plan_request(certain_belief(ground_of(random_rocks(seed))), start);
      request.start_curvature_per_m = uniform(random, -0.8, 0.8);
      request.start_reverse = seed % 5 == 0;
      const Plan plan = plan_on(request);
      if (plan.found) out.push_back({"seed " + std::to_string(seed), request, plan});
    }
    return out;
  }();
  return fields;
}

TEST(HybridPlanner, OnFreeGroundThePlanIsStraight) {
  const Plan plan = plan_on(free_ground);
  ASSERT_TRUE(plan.found);
  EXPECT_FALSE(plan.keeps_incumbent);
  EXPECT_GE(plan.poses.back().pose.x_m, search_config().horizon_m);
  EXPECT_NEAR(length_of(plan), plan.poses.back().pose.x_m, 0.02);
  EXPECT_EQ(point_turns(plan), 0);
  EXPECT_FALSE(reverses(plan));
  EXPECT_LT(plan.expansions, 100);
  EXPECT_GT(plan.clearance_m, 1.0);
}

// Poses are those of the body, which moves at an angle to its heading.
TEST(HybridPlanner, OnASideSlopeTheBodyPointsUphillAndKeepsItsClearance) {
  const BeliefMap belief =
      certain_belief([](Point2 p) { return hazard_if(p.x_m > 1.5 && p.x_m < 6.0 && std::abs(p.y_m + 0.75) < 0.1); });
  PlanRequest request = plan_request(belief);
  request.side_slip.downhill = {0.0, -0.15};
  const Plan plan = plan_on(request);
  ASSERT_TRUE(plan.found);
  expect_keeps_clearance(plan, request);
  for (size_t i = 1; i < plan.poses.size(); ++i) {
    const Pose2& from = plan.poses[i - 1].pose;
    const Pose2& to = plan.poses[i].pose;
    if (is_point_turn(plan.poses[i - 1], plan.poses[i]) || plan.poses[i].reverse) continue;
    const double moved_rad = std::atan2(to.y_m - from.y_m, to.x_m - from.x_m);
    const double slip_rad = wrap_angle(moved_rad - from.yaw_rad - 0.5 * wrap_angle(to.yaw_rad - from.yaw_rad));
    EXPECT_NEAR(slip_rad, std::atan(request.side_slip.at(from.yaw_rad)), 0.01) << "pose " << i;
  }
}

TEST(HybridPlanner, OnRandomFieldsItNearlyAlwaysFindsAPlan) {
  EXPECT_GT(static_cast<double>(planned_fields().size()), 0.9 * kFields);
  int bent = 0;
  for (const PlannedField& field : planned_fields()) bent += length_of(field.plan) > 6.15 ? 1 : 0;
  EXPECT_GT(bent, 10) << "the fields are too easy";
}

TEST(HybridPlanner, OnRandomFieldsItKeepsTheMinimumClearance) {
  for (const PlannedField& field : planned_fields()) {
    SCOPED_TRACE(field.name);
    expect_keeps_clearance(field.plan, field.request);
    EXPECT_GE(field.plan.clearance_m, search_config().clearances.min_m);
  }
}

TEST(HybridPlanner, OnRandomFieldsItKeepsTheLimitsOfTheSteering) {
  for (const PlannedField& field : planned_fields()) {
    SCOPED_TRACE(field.name);
    EXPECT_EQ(distance(position(field.plan.poses.front().pose), position(field.request.start)), 0.0);
    expect_drivable(field.plan, field.request.start_curvature_per_m);
  }
}

// Also beside a rock that is nearer than a plan would come.
TEST(HybridPlanner, ThePathMonitorAcceptsEachPlan) {
  const HybridPlannerConfig config = search_config();
  int near = 0;
  for (std::uint64_t seed = 1; seed <= kFields; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    const Pose2 start{0.0, 0.0, uniform(random, -1.0, 1.0)};
    const double side = seed % 2 == 0 ? 1.0 : -1.0;
    const Point2 beside = from_body(start, {uniform(random, -0.8, 0.8), side * uniform(random, 0.5, 0.6)});
    const GroundAt rocks = ground_of(random_rocks(seed));
    const PlanRequest request = plan_request(
        certain_belief([&](Point2 p) { return distance(p, beside) < 0.06 ? Ground::kHazard : rocks(p); }), start);
    const Plan plan = plan_on(request);
    if (!plan.found) continue;
    near += FootprintCheck(*request.costmap, config.footprint, config.clearances.min_m, 0.0, 0.0, {9.0, 9.0, 0.0})
                    .clear(start)
                ? 0
                : 1;
    ActivePath path;
    path.set_plan(1, PathKind::kRepair, plan.poses, {}, 0.25, 0, start);
    const double turn_rad = std::abs(wrap_angle(path.route().pose_at(0.0).yaw_rad - start.yaw_rad));
    const bool turning = turn_rad > Route::kCornerRad;
    const Blockage blockage = find_blockage({*request.costmap,
                                             path.route(),
                                             config.footprint,
                                             0.0,
                                             start,
                                             start,
                                             config.clearances.min_m - 0.03,
                                             {},
                                             turning,
                                             config.view});
    EXPECT_TRUE(std::isinf(blockage.hazard_m)) << blockage.hazard_m;
  }
  EXPECT_GT(near, 10);
}

// Hazards all around, so near that most point turns are blocked: where no plan is found, none is found either from a
// place that the rover can reach straight ahead or back.
TEST(HybridPlanner, AmongNearHazardsItFindsAWayIfAShortStraightMotionHasOne) {
  constexpr int kNear = 7;
  const HybridPlannerConfig config = search_config();
  int found = 0;
  for (std::uint64_t seed = 50; seed < 64; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    const Pose2 start{0.0, 0.0, uniform(random, -kPi, kPi)};
    std::vector<Point2> near;
    while (near.size() < kNear) {
      const Point2 p{uniform(random, -1.8, 1.8), uniform(random, -1.3, 1.3)};
      if (config.footprint.distance_m(p) > 0.2) near.push_back(from_body(start, p));
    }
    const GroundAt rocks = ground_of(random_rocks(seed));
    const auto ground = [&](Point2 p) {
      const bool hazard = std::any_of(near.begin(), near.end(), [&](Point2 q) { return distance(p, q) < 0.08; });
      return hazard ? Ground::kHazard : rocks(p);
    };
    PlanRequest request = plan_request(certain_belief(ground), start);
    if (plan_on(request).found) {
      ++found;
      continue;
    }
    const FootprintCheck check(*request.costmap, config.footprint, config.clearances.min_m, kApproachM, 0.0, start);
    for (const double side : {1.0, -1.0})
      for (double x_m = 0.05; x_m < 1.2; x_m += 0.05) {
        request.start = advanced(start, side * x_m, 0.0);
        if (!check.clear(request.start)) break;
        EXPECT_FALSE(plan_on(request).found) << side * x_m;
      }
  }
  EXPECT_GT(found, 5);
}

// The search also counts the heading at the end of a plan.
TEST(HybridPlanner, AnIncumbentCostsWhatTheSamePlanCosts) {
  for (size_t i = 0; i < planned_fields().size(); i += 5) {
    const PlannedField& field = planned_fields()[i];
    SCOPED_TRACE(field.name);
    PlanRequest request = field.request;
    request.incumbent = field.plan.poses;
    const Plan again = plan_on(request);
    EXPECT_TRUE(again.keeps_incumbent);
    EXPECT_NEAR(again.cost, field.plan.cost, 0.5 * search_config().switching_cost_s);
  }
}

TEST(HybridPlanner, GoesThroughAGapThatFits) {
  for (const double middle_m : {-2.5, -1.0, 0.6, 2.2}) {
    SCOPED_TRACE(middle_m);
    const PlanRequest request = plan_request(certain_belief(wall({{middle_m, 1.7}})));
    const Plan plan = plan_on(request);
    ASSERT_TRUE(plan.found);
    EXPECT_NEAR(y_at(plan, kWallM), middle_m, 0.4);
    expect_keeps_clearance(plan, request);
    expect_drivable(plan);
  }
}

TEST(HybridPlanner, GoesAroundAGapThatDoesNotFit) {
  const double width_m = 2.0 * search_config().footprint.half_width_m;
  EXPECT_NEAR(y_at(plan_on(wall({{0.0, width_m}, {3.5, 2.0}})), kWallM), 3.5, 0.6);
}

TEST(HybridPlanner, ATightGapIsTakenIfTheDetourIsLong) {
  EXPECT_NEAR(y_at(plan_on(wall({{0.05, 1.2}, {7.0, 3.0}})), kWallM), 0.0, 0.2);
  EXPECT_GT(y_at(plan_on(wall({{0.05, 1.2}, {2.4, 3.0}})), kWallM), 0.8);
}

TEST(HybridPlanner, OutOfANarrowPassageItReverses) {
  const PlanRequest request = plan_request(certain_belief(blocked_passage(0.7)));
  const Plan plan = plan_on(request);
  ASSERT_TRUE(plan.found);
  EXPECT_TRUE(reverses(plan));
  expect_keeps_clearance(plan, request);
  expect_drivable(plan);
  EXPECT_FALSE(plan.poses.back().reverse);
}

TEST(HybridPlanner, InAPointTurnItMayTurnBackByASmallAngle) {
  PlanRequest request = plan_request(certain_belief(blocked_passage(0.7)), {0.0, 0.0, 0.28});
  EXPECT_FALSE(plan_on(request).found);
  request.turning = true;
  const Plan plan = plan_on(request);
  ASSERT_TRUE(plan.found);
  EXPECT_EQ(position(plan.poses[1].pose).x_m, 0.0);
  EXPECT_NEAR(plan.poses[1].pose.yaw_rad, 0.28 - to_rad(15.0), 1e-9);
  expect_keeps_clearance(plan, request);
}

TEST(HybridPlanner, OutOfAWidePassageItTurns) {
  const PlanRequest request = plan_request(certain_belief(blocked_passage(1.6)));
  const Plan plan = plan_on(request);
  ASSERT_TRUE(plan.found);
  EXPECT_TRUE(point_turns(plan) > 0 || reverses(plan));
  expect_keeps_clearance(plan, request);
  expect_drivable(plan);
}

TEST(HybridPlanner, ReversesOnlyOverKnownGround) {
  const GroundAt narrow = blocked_passage(0.7);
  EXPECT_TRUE(plan_on(narrow).found);
  const Plan plan = plan_on([&](Point2 p) { return p.x_m < -1.5 ? Ground::kUnknown : narrow(p); });
  EXPECT_FALSE(plan.found);
  EXPECT_TRUE(plan.poses.empty());
}

TEST(HybridPlanner, GroundNearbyIsKnownOrSeenInTime) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const GroundAt rocks = ground_of(random_rocks(seed));
    const PlanRequest request =
        plan_request(certain_belief([&](Point2 p) {
                       return search_config().footprint.distance_m(p) > 0.5 ? Ground::kUnknown : rocks(p);
                     }),
                     {0.0, 0.0, 0.1 * static_cast<double>(seed)});
    const Plan plan = plan_on(request);
    found += plan.found ? 1 : 0;
    expect_seen_in_time(plan, request);
  }
  EXPECT_GT(found, 5);
}

TEST(HybridPlanner, EnclosedThereIsNoPlan) {
  const Plan plan = plan_on([](Point2 p) { return hazard_if(std::abs(distance(p, {}) - 2.1) < 0.15); });
  EXPECT_FALSE(plan.found);
  EXPECT_TRUE(plan.poses.empty());
  EXPECT_FALSE(plan.needs_unseen_ground);
  EXPECT_TRUE(plan.closed_in);
}

TEST(HybridPlanner, SaysThatUnseenGroundWouldBeNeeded) {
  const Plan plan = plan_on(
      [](Point2 p) { return search_config().footprint.distance_m(p) < 0.15 ? Ground::kFree : Ground::kUnknown; });
  EXPECT_FALSE(plan.found);
  EXPECT_TRUE(plan.needs_unseen_ground);
  EXPECT_FALSE(plan.closed_in);
}

TEST(HybridPlanner, TheSameRequestGivesTheSamePlan) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const BeliefMap belief = certain_belief(ground_of(random_rocks(seed)));
    const Plan a = plan_on(plan_request(belief));
    const Plan b = plan_on(plan_request(belief));
    EXPECT_EQ(a.cost, b.cost);
    EXPECT_EQ(a.expansions, b.expansions);
    ASSERT_EQ(a.poses.size(), b.poses.size());
    for (size_t i = 0; i < a.poses.size(); ++i) {
      EXPECT_EQ(a.poses[i].pose.x_m, b.poses[i].pose.x_m);
      EXPECT_EQ(a.poses[i].pose.yaw_rad, b.poses[i].pose.yaw_rad);
    }
  }
}

TEST(HybridPlanner, StartsAtTheCurvatureAndInTheDirectionOfTheRover) {
  PlanRequest request = plan_request(certain_belief(free_ground));
  request.start_curvature_per_m = 0.5;
  const Plan curved = plan_on(request);
  ASSERT_TRUE(curved.found);
  EXPECT_NEAR(curved.poses[1].pose.yaw_rad / 0.05, 0.5, 0.15);
  request.start_curvature_per_m = 0.0;
  request.start_reverse = true;
  const Plan reverse = plan_on(request);
  ASSERT_TRUE(reverse.found);
  EXPECT_TRUE(reverse.poses.front().reverse);
  EXPECT_GT(reverse.cost, curved.cost) << "it has to stop";
}

// Two gaps, of which the right one is a little nearer.
constexpr Gap kRight{-1.0, 2.0};
constexpr Gap kLeft{1.8, 2.0};

// A plan through the left gap, made when that was the only one.
PlanRequest with_incumbent(const GroundAt& ground, const Gap& gap = kLeft) {
  PlanRequest request = plan_request(certain_belief(ground));
  request.incumbent = plan_on(wall({gap})).poses;
  return request;
}

TEST(HybridPlanner, TheIncumbentIsKeptIfAnotherPlanIsHardlyCheaper) {
  const Plan other = plan_on(wall({kLeft, kRight}));
  ASSERT_LT(y_at(other, kWallM), 0.0);
  const Plan kept = plan_on(with_incumbent(wall({kLeft, kRight})));
  EXPECT_TRUE(kept.keeps_incumbent);
  EXPECT_FALSE(kept.found);
  EXPECT_GT(kept.cost, other.cost);
  EXPECT_LT(kept.cost - other.cost, search_config().switching_cost_s);
}

TEST(HybridPlanner, WhereNoPathCanBeMuchCheaperTheIncumbentIsKeptWithoutASearch) {
  PlanRequest request = plan_request(certain_belief(free_ground));
  const Plan first = plan_on(request);
  EXPECT_GT(first.expansions, 0);
  request.incumbent = first.poses;
  const Plan kept = plan_on(request);
  EXPECT_TRUE(kept.keeps_incumbent);
  EXPECT_EQ(kept.expansions, 0);
  EXPECT_NEAR(kept.cost, first.cost, 1.0);
}

// A rock that only the rear corner of the turning rover sweeps.
TEST(HybridPlanner, AnIncumbentIsNotKeptWhosePointTurnARockBlocks) {
  constexpr Point2 kCorner{1.5, 0.0};
  constexpr Point2 kSwept{0.81, -0.69};
  std::vector<PlanPose> incumbent;
  for (int i = 0; i <= 30; ++i) incumbent.push_back({{kCorner.x_m * i / 30.0, 0.0, 0.0}});
  for (int i = 0; i <= 200; ++i) incumbent.push_back({{kCorner.x_m, 0.05 * i, 0.5 * kPi}});
  for (const bool rock : {false, true}) {
    const GroundAt ground = [&](Point2 p) { return hazard_if(rock && distance(p, kSwept) < 0.08); };
    PlanRequest request = plan_request(certain_belief(ground), {}, {{-3.0, 0.0}, kCorner, {kCorner.x_m, 30.0}});
    request.incumbent = incumbent;
    EXPECT_EQ(plan_on(request).keeps_incumbent, !rock);
  }
}

// The lattice of the SE(2) cost-to-go has such arcs too; without them the plan turns on the spot twice.
TEST(HybridPlanner, AVehicleThatTurnsInWiderArcsGetsWiderArcs) {
  HybridPlannerConfig config = search_config();
  config.motion.max_curvature_per_m = 0.25;
  const Plan plan = HybridPlanner(config).plan(plan_request(certain_belief(wall({{1.0, 1.6}}))));
  ASSERT_TRUE(plan.found);
  EXPECT_LE(point_turns(plan), 1);
  for (size_t i = 1; i < plan.poses.size(); ++i) {
    if (is_point_turn(plan.poses[i - 1], plan.poses[i])) continue;
    EXPECT_LE(std::abs(wrap_angle(plan.poses[i].pose.yaw_rad - plan.poses[i - 1].pose.yaw_rad)), 0.25 * 0.0501 + 1e-6);
  }
}

TEST(HybridPlanner, AMuchCheaperPlanReplacesTheIncumbent) {
  constexpr Gap kFarLeft{4.0, 2.0};
  const Plan plan = plan_on(with_incumbent(wall({kFarLeft, {0.0, 2.0}}), kFarLeft));
  EXPECT_TRUE(plan.found);
  EXPECT_FALSE(plan.keeps_incumbent);
  EXPECT_NEAR(y_at(plan, kWallM), 0.0, 0.5);
}

TEST(HybridPlanner, APlanCheaperByTheSwitchingCostReplacesTheIncumbentHoweverFarTheGoal) {
  constexpr Gap kFarLeft{3.0, 2.0};
  for (const double goal_x_m : {12.0, 30.0, 90.0}) {
    const std::vector<Point2> path = {{-3.0, 0.0}, {goal_x_m, 0.0}};
    PlanRequest request = plan_request(certain_belief(wall({kFarLeft, kRight})), {}, path);
    const double best_s = plan_on(request).cost;
    request.incumbent = plan_on(plan_request(certain_belief(wall({kFarLeft})), {}, path)).poses;
    HybridPlannerConfig config = search_config();
    config.switching_cost_s = 1000.0;
    const double saved_s = HybridPlanner(config).plan(request).cost - best_s;
    ASSERT_GT(saved_s, 1.5 * search_config().switching_cost_s);
    EXPECT_TRUE(plan_on(request).found) << goal_x_m << " m: saves " << saved_s << " s";
  }
}

TEST(HybridPlanner, ABlockedIncumbentIsDropped) {
  const Plan plan = plan_on(with_incumbent(wall({{-4.0, 2.0}})));
  EXPECT_TRUE(plan.found);
  EXPECT_LT(y_at(plan, kWallM), -3.0);
  const Plan none = plan_on(with_incumbent([](Point2 p) { return hazard_if(std::abs(distance(p, {}) - 2.1) < 0.15); }));
  EXPECT_FALSE(none.found);
  EXPECT_FALSE(none.keeps_incumbent);
}

TEST(HybridPlanner, EndsAtAGoalWithinTheMap) {
  const PlanRequest request = plan_request(certain_belief(free_ground), {}, {{-3.0, 0.0}, {4.0, 0.5}});
  const Plan plan = plan_on(request);
  ASSERT_TRUE(plan.found);
  EXPECT_LE(distance(position(plan.poses.back().pose), {4.0, 0.5}), request.goal_tolerance_m);
}

TEST(HybridPlanner, AGoalWithHazardsIsReachedBesideThem) {
  const Point2 goal{4.0, 0.0};
  const PlanRequest request = plan_request(certain_belief([&](Point2 p) { return hazard_if(distance(p, goal) < 0.3); }),
                                           {}, {{-3.0, 0.0}, goal});
  const Plan plan = plan_on(request);
  ASSERT_TRUE(plan.found);
  const double miss_m = distance(position(plan.poses.back().pose), goal);
  EXPECT_LE(miss_m, search_config().cost_to_go.blocked_goal_radius_m);
  EXPECT_GT(miss_m, request.goal_tolerance_m);
  expect_keeps_clearance(plan, request);
}

TEST(HybridPlanner, DifficultGroundIsDrivenAroundIfTheDetourIsShort) {
  BeliefMap belief = certain_belief(free_ground);
  GridMap<CellBelief>& map = belief.cells();
  map.for_each([&](CellIndex i, CellBelief& cell) {
    const Point2 p{map.center_x_m(i), map.center_y_m(i)};
    if (std::abs(p.x_m - 3.0) < 1.0 && std::abs(p.y_m - 0.4) < 0.6) cell.cost = 0.9F;
  });
  EXPECT_LT(y_at(plan_on(plan_request(belief)), 3.0), -0.4);
}

// The committed path ends past a point turn, which will show the ground ahead.
TEST(HybridPlanner, CountsWhatTheRoverSeesOnTheWayToTheStart) {
  const BeliefMap belief = certain_belief([](Point2 p) { return p.y_m < 1.3 ? Ground::kFree : Ground::kUnknown; });
  PlanRequest request = plan_request(belief, {0.0, 0.0, 0.5 * kPi}, {{0.0, -3.0}, {0.0, 30.0}});
  request.rover = {};
  const Plan blind = plan_on(request);
  EXPECT_TRUE(blind.needs_unseen_ground);
  request.views = turn_views(0.0, request.start);
  const Plan plan = plan_on(request);
  ASSERT_TRUE(plan.found);
  EXPECT_LT(plan.cost, blind.cost - 1.0);
}

}  // namespace
}  // namespace rover::planning
