// How far the swept footprint can follow a path.
#include "path_planner/path_monitor.hpp"

#include <gtest/gtest.h>

#include "test/path_planner/plan_scene.hpp"

namespace rover::planning {
namespace {

using testing_support::certain_belief;
using testing_support::Ground;
using testing_support::ground_of;
using testing_support::GroundAt;
using testing_support::planner_config;

class PathMonitorTest : public testing::Test {
 protected:
  static constexpr double kMarginM = 0.1;

  void set_path(const std::vector<Point2>& points, bool reverse = false) {
    std::vector<RoutePoint> route;
    for (const Point2& p : points) route.push_back({p, kNaN, 0, reverse});
    route_ = Route(std::move(route));
  }
  Blockage blockage(const GroundAt& ground) const {
    const Costmap costmap({}, certain_belief(ground), {}, 14.0);
    return find_blockage({.costmap = costmap,
                          .route = route_,
                          .footprint = footprint_,
                          .from_m = from_m_,
                          .rover = rover_,
                          .margin_m = kMarginM,
                          .turning = turning_,
                          .view = ViewArea{},
                          .side_slip = side_slip_});
  }
  // A spot of a cell.
  static GroundAt spot(Ground kind, Point2 at) {
    return [=](Point2 p) { return distance(p, at) < 0.06 ? kind : Ground::kFree; };
  }

  Footprint footprint_ = planner_config().footprint;
  Route route_{{{{-2.0, 0.0}, kNaN, 0}, {{20.0, 0.0}, kNaN, 0}}};
  double from_m_ = 2.0;  // where the rover is
  Pose2 rover_;
  bool turning_ = false;
  SideSlip side_slip_;
};

TEST_F(PathMonitorTest, OnFreeGroundThePathIsClear) {
  EXPECT_TRUE(std::isinf(blockage(ground_of({})).hazard_m));
  EXPECT_TRUE(std::isinf(blockage(ground_of({})).unknown_m));
}

TEST_F(PathMonitorTest, AHazardBlocksWhereTheFrontComesWithinTheMargin) {
  const double expected_m = from_m_ + 4.05 - footprint_.half_length_m - kMarginM;
  EXPECT_NEAR(blockage(spot(Ground::kHazard, {4.05, 0.35})).hazard_m, expected_m, 0.06);
  EXPECT_TRUE(std::isinf(blockage(spot(Ground::kHazard, {4.05, 0.65})).hazard_m)) << "beside the path";
  EXPECT_TRUE(std::isinf(blockage(spot(Ground::kHazard, {-2.05, 0.05})).hazard_m)) << "behind";
}

TEST_F(PathMonitorTest, OnASideSlopeTheFrontSwingsUphill) {
  const GroundAt uphill = spot(Ground::kHazard, {4.05, 0.65});
  EXPECT_TRUE(std::isinf(blockage(uphill).hazard_m));
  side_slip_.downhill = {0.0, -0.15};
  EXPECT_TRUE(std::isfinite(blockage(uphill).hazard_m));
}

TEST_F(PathMonitorTest, UnknownGroundBlocksWhereTheFrontReachesIt) {
  const GroundAt beyond = [](Point2 p) { return p.x_m > 4.0 ? Ground::kUnknown : Ground::kFree; };
  EXPECT_NEAR(blockage(beyond).unknown_m, from_m_ + 4.0 - footprint_.half_length_m, 0.11);
  EXPECT_TRUE(std::isinf(blockage(beyond).hazard_m));
}

TEST_F(PathMonitorTest, UnknownGroundThatComesIntoViewIsNotUnseen) {
  const GroundAt ahead = [](Point2 p) { return p.x_m > 4.0 ? Ground::kUnknown : Ground::kFree; };
  EXPECT_TRUE(std::isinf(blockage(ahead).unseen_m));
  const GroundAt here = [&](Point2 p) { return footprint_.distance_m(p) > 0.2 ? Ground::kUnknown : Ground::kFree; };
  EXPECT_LT(blockage(here).unseen_m, from_m_ + 0.3);
}

TEST_F(PathMonitorTest, InReverseTheRearLeads) {
  set_path({{2.0, 0.0}, {-6.0, 0.0}}, true);
  const double expected_m = from_m_ + 3.05 - footprint_.half_length_m - kMarginM;
  EXPECT_NEAR(blockage(spot(Ground::kHazard, {-3.05, 0.05})).hazard_m, expected_m, 0.06);
}

// In reverse for 2 m, then forward to the left: the rear is checked as far as the cusp, then the front.
TEST_F(PathMonitorTest, BeyondACuspThePathIsCheckedToo) {
  route_ = Route({{{0.0, 0.0}, kNaN, 0, true}, {{-2.0, 0.0}, kNaN, 0, false}, {{4.0, 1.5}, kNaN, 0, false}});
  from_m_ = 0.0;
  EXPECT_TRUE(std::isinf(blockage(spot(Ground::kHazard, {-3.25, 0.05})).hazard_m));
  EXPECT_LT(blockage(spot(Ground::kHazard, {-2.85, 0.05})).hazard_m, 2.0);
  const double beyond_m = blockage(spot(Ground::kHazard, {2.45, 1.15})).hazard_m;
  EXPECT_GT(beyond_m, 4.5);
  EXPECT_LT(beyond_m, 6.5);
}

TEST_F(PathMonitorTest, APointTurnSweepsTheCorners) {
  const GroundAt beside = spot(Ground::kHazard, {0.05, 0.85});  // within the radius of the footprint
  EXPECT_TRUE(std::isinf(blockage(beside).hazard_m));
  rover_.yaw_rad = 0.5 * kPi;
  turning_ = true;
  EXPECT_NEAR(blockage(beside).hazard_m, from_m_, 1e-9);
  rover_.yaw_rad = 0.0;
  turning_ = false;
  set_path({{-5.0, 0.0}, {0.0, 0.0}, {0.0, -6.0}});
  from_m_ = 2.0;
  rover_.x_m = -3.0;
  EXPECT_NEAR(blockage(spot(Ground::kHazard, {0.05, 0.85})).hazard_m, 5.0, 0.06);
}

TEST_F(PathMonitorTest, ARoverBesideThePathIsCheckedWhereItIs) {
  const GroundAt beside = spot(Ground::kHazard, {1.05, 0.75});
  EXPECT_TRUE(std::isinf(blockage(beside).hazard_m));
  rover_.y_m = 0.25;
  EXPECT_LT(blockage(beside).hazard_m, from_m_ + 0.5);
}

}  // namespace
}  // namespace rover::planning
