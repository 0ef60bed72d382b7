// Roll at a pose, and what it costs and forbids.
#include "path_planner/search/roll.hpp"

#include <gtest/gtest.h>

#include "path_planner/path_monitor.hpp"
#include "path_planner/search/hybrid_planner.hpp"
#include "test/path_planner/plan_scene.hpp"

namespace rover::planning {
namespace {

using testing_support::certain_belief;
using testing_support::ground_of;
using testing_support::plan_request;
using testing_support::planner_config;
using testing_support::set_heights;
using testing_support::side_slope;

constexpr Pose2 kAcross{0.0, 0.0, 0.0};
constexpr Pose2 kDown{0.0, 0.0, -0.5 * kPi};

// A plane that rises to the left of the heading 0.
Costmap slope_of(double deg, CostmapUse use = CostmapUse::kGoingOn) {
  BeliefMap belief = certain_belief(ground_of({}));
  if (deg > 0.0) set_heights(belief, [=](Point2 p) { return side_slope(deg, p); });
  CostmapConfig config;
  config.use = use;
  return Costmap(config, belief, {}, 14.0);
}

RollCheck check_on(const Costmap& costmap, const Pose2& rover = kDown) {
  return {RollCosts{}, costmap, planner_config().footprint, rover};
}

TEST(Roll, IsTheSlopeAcrossTheHeading) {
  const Costmap costmap = slope_of(12.0);
  const RollCheck check = check_on(costmap);
  EXPECT_NEAR(to_deg(check.roll_rad(kAcross)), 12.0, 1.0);
  EXPECT_NEAR(to_deg(check.roll_rad({0.0, 0.0, kPi})), 12.0, 1.0);
  EXPECT_NEAR(to_deg(check.roll_rad(kDown)), 0.0, 1.0);
}

TEST(Roll, OfWheelsOnAStoneIsThatOfAThirdOfIt) {
  BeliefMap belief = certain_belief(ground_of({}));
  const Point2 wheel = planner_config().footprint.wheels[0];
  set_heights(belief, [&](Point2 p) { return distance(p, wheel) < 0.15 ? 0.12 : 0.0; });
  const Costmap costmap({}, belief, {}, 14.0);
  EXPECT_NEAR(check_on(costmap).roll_rad(kAcross), 0.04 / (2.0 * wheel.y_m), 0.002);
}

TEST(Roll, IsNotLimitedWhereHeightsAreNotKnown) {
  const Costmap without = slope_of(0.0);
  EXPECT_TRUE(check_on(without).allows(kAcross));
  EXPECT_EQ(check_on(without).factor(kAcross), 1.0);
  const Costmap steep = slope_of(30.0);
  EXPECT_TRUE(check_on(steep).allows({100.0, 0.0, 0.0})) << "outside of the map";
}

TEST(Roll, CostsFromThreeQuartersOfTheLargestAndIsForbiddenAboveIt) {
  const RollCosts costs;
  const auto factor = [&](double deg) {
    const Costmap costmap = slope_of(deg);
    return check_on(costmap).factor(kAcross);
  };
  const double max_deg = to_deg(costs.max_rad);
  EXPECT_EQ(factor(RollCosts::kFreeRatio * max_deg - 1.5), 1.0);
  EXPECT_NEAR(factor(max_deg - 1.0), 1.0 + costs.cost, 1.0);
  EXPECT_TRUE(std::isinf(factor(max_deg + 1.5)));
}

TEST(Roll, MoreIsAllowedOnlyAsFarAsTheRoverHasItAlready) {
  const Costmap costmap = slope_of(22.0);
  EXPECT_FALSE(check_on(costmap, kDown).allows(kAcross));
  EXPECT_TRUE(check_on(costmap, kAcross).allows(kAcross));
  const Costmap back = slope_of(22.0, CostmapUse::kBackingUp);
  EXPECT_TRUE(check_on(back, kDown).allows(kAcross)) << "where it came from it may go back";
}

// The direct way leads over a bank across the path.
class BankTest : public testing::Test {
 protected:
  static PlanRequest over_bank(double deg, const Pose2& start = {}) {
    BeliefMap belief = certain_belief(ground_of({}));
    set_heights(belief, [=](Point2 p) {
      const bool bank = p.x_m > 2.0 && p.x_m < 5.0 && std::abs(p.y_m) < 1.0;
      return bank ? side_slope(deg, p) : 0.0;
    });
    return plan_request(belief, start);
  }
  static double max_roll_deg(const Plan& plan, const PlanRequest& request) {
    const RollCheck check = check_on(*request.costmap);
    double most = 0.0;
    for (const PlanPose& at : plan.poses) most = std::max(most, check.roll_rad(at.pose));
    return to_deg(most);
  }
  static Plan plan_on(const PlanRequest& request) {
    return HybridPlanner(testing_support::search_config()).plan(request);
  }
};

TEST_F(BankTest, APlanKeepsItsRollBelowTheLargest) {
  const PlanRequest request = over_bank(25.0);
  const Plan plan = plan_on(request);
  ASSERT_TRUE(plan.found);
  EXPECT_LE(max_roll_deg(plan, request), to_deg(RollCosts{}.max_rad));
}

TEST_F(BankTest, AnEasyBankIsCrossed) {
  const PlanRequest request = over_bank(10.0);
  const Plan plan = plan_on(request);
  ASSERT_TRUE(plan.found);
  for (const PlanPose& at : plan.poses) EXPECT_LT(std::abs(at.pose.y_m), 0.2);
}

TEST_F(BankTest, AFarBankThatTurnsOutSteepBlocksThePath) {
  const Route path({{{-2.0, 0.0}, kNaN, 0}, {{20.0, 0.0}, kNaN, 0}});
  const auto blocked_m = [&](double deg) {
    const PlanRequest request = over_bank(deg);
    return find_blockage({.costmap = *request.costmap,
                          .route = path,
                          .footprint = planner_config().footprint,
                          .from_m = 2.0,
                          .margin_m = 0.1,
                          .view = ViewArea{}})
        .hazard_m;
  };
  EXPECT_TRUE(std::isinf(blocked_m(15.0)));
  EXPECT_NEAR(blocked_m(25.0), 4.5, 1.2);
}

}  // namespace
}  // namespace rover::planning
