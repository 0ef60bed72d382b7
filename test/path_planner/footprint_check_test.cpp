// The exact test of the footprint against hazards and unknown ground, and what the LocCam sees in time.
#include "path_planner/search/footprint_check.hpp"

#include <gtest/gtest.h>

#include "test/path_planner/plan_scene.hpp"

namespace rover::planning {
namespace {

using testing_support::certain_belief;
using testing_support::Ground;
using testing_support::ground_of;
using testing_support::GroundAt;
using testing_support::planner_config;
using testing_support::random_pose;
using testing_support::Rock;
using testing_support::uniform;

constexpr double kMarginM = 0.17;
constexpr double kApproachM = 0.02;
const Footprint kRover = planner_config().footprint;

Costmap costmap_of(const GroundAt& ground) {
  return Costmap({}, certain_belief(ground), {}, 12.0);
}

FootprintCheck check_of(const Costmap& costmap, const Pose2& start = {9.0, 9.0, 0.0}) {
  return FootprintCheck(costmap, kRover, kMarginM, kApproachM, 0.0, start);
}

GroundAt scattered(Ground kind, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Point2> spots;
  for (int i = 0; i < 30; ++i) spots.push_back(position(random_pose(random, 4.5)));
  return [=](Point2 p) {
    const auto near = [&](Point2 spot) { return distance(spot, p) < 0.25; };
    return std::any_of(spots.begin(), spots.end(), near) ? kind : Ground::kFree;
  };
}

double brute_clearance_m(const Costmap& costmap, const Pose2& pose) {
  double nearest = kInfinity;
  for (const Hazard& h : costmap.hazards()) nearest = std::min(nearest, kRover.distance_m(pose, h.p));
  return nearest;
}

TEST(FootprintCheck, IsClearWhereNoHazardIsWithinTheMargin) {
  const Costmap costmap = costmap_of(scattered(Ground::kHazard, 1));
  const FootprintCheck check = check_of(costmap);
  std::mt19937_64 random(2);
  int clear = 0;
  for (int i = 0; i < 1000; ++i) {
    const Pose2 pose = random_pose(random, 4.0);
    const double clearance_m = brute_clearance_m(costmap, pose);
    ASSERT_EQ(check.clear(pose), clearance_m >= kMarginM) << i;
    ASSERT_NEAR(check.clearance_m(pose, 1.0), std::min(clearance_m, 1.0), 1e-9) << i;
    clear += check.clear(pose) ? 1 : 0;
  }
  EXPECT_GT(clear, 100);
  EXPECT_LT(clear, 900);
}

TEST(FootprintCheck, AllowsASlideBesideAHazardButNotOntoIt) {
  constexpr Point2 kBeside{0.05, 0.55};
  const Costmap costmap =
      costmap_of([&](Point2 p) { return distance(p, kBeside) < 0.02 ? Ground::kHazard : Ground::kFree; });
  ASSERT_EQ(costmap.hazards().size(), 1u);
  const double beside_m = brute_clearance_m(costmap, {});
  ASSERT_GT(beside_m, 0.05);
  ASSERT_LT(beside_m, kMarginM);
  FootprintCheck check = check_of(costmap, {});
  const double to_cell_m = beside_m - 0.5 * costmap.cell_m();
  const Pose2 nearer{0.0, to_cell_m - 0.001, 0.0};
  const Pose2 onto{0.0, to_cell_m + 0.01, 0.0};
  EXPECT_FALSE(check.clear(nearer));
  check.allow_slide(0.05);
  EXPECT_TRUE(check.clear(nearer));
  check.allow_slide(1.0);
  EXPECT_FALSE(check.clear(onto));
}

// Unknown spots are wider than the gaps between the points that are looked at.
TEST(FootprintCheck, IsKnownWhereNoUnknownGroundLiesUnderTheEdge) {
  const Costmap costmap = costmap_of(scattered(Ground::kUnknown, 3));
  const FootprintCheck check = check_of(costmap);
  std::mt19937_64 random(4);
  int known = 0;
  for (int i = 0; i < 1000; ++i) {
    const Pose2 pose = random_pose(random, 4.0);
    double deepest_m = 0.0;  // how far unknown ground reaches over the edge, both inwards and outwards
    for (int cell = 0; cell < costmap.cells() * costmap.cells(); ++cell) {
      if (!costmap.unknown(cell)) continue;
      const double edge_m = std::abs(kRover.distance_m(pose, costmap.center_of(cell)));
      deepest_m = std::max(deepest_m, 0.07 - edge_m);
    }
    ASSERT_TRUE(deepest_m > 0.0 || check.known(pose)) << i;
    ASSERT_FALSE(deepest_m > 0.06 && check.known(pose)) << i;
    known += check.known(pose) ? 1 : 0;
  }
  EXPECT_GT(known, 100);
  EXPECT_LT(known, 900);
}

TEST(FootprintCheck, ARoverNearAHazardMayLeaveItButNotApproachIt) {
  const Costmap costmap = costmap_of([](Point2 p) {
    return distance(p, {0.95, 0.05}) < 0.01 ? Ground::kHazard : Ground::kFree;  // 0.075 m ahead of the footprint
  });
  const FootprintCheck check = check_of(costmap, {});
  EXPECT_TRUE(check.clear({0.0, 0.0, 0.0}));
  EXPECT_TRUE(check.clear({-0.05, 0.0, 0.0}));
  EXPECT_TRUE(check.clear({-0.2, 0.0, 0.0}));
  EXPECT_FALSE(check.clear({0.05, 0.0, 0.0}));
  EXPECT_FALSE(check.clear({0.2, 0.0, 0.0}));
}

TEST(FootprintCheck, ARoverThatTouchesAHazardMayLeaveItButNotDriveOverIt) {
  const Costmap costmap = costmap_of([](Point2 p) {
    return distance(p, {0.05, 0.45}) < 0.01 || distance(p, {1.55, 0.05}) < 0.01 ? Ground::kHazard : Ground::kFree;
  });
  const Pose2 start{0.0, -0.03, 0.0};  // 1 cm beside it
  const FootprintCheck check = check_of(costmap, start);
  EXPECT_TRUE(check.clear(start));
  EXPECT_TRUE(check.clear({-0.5, -0.03, 0.0}));
  EXPECT_FALSE(check.clear({0.0, 0.0, 0.0}));
  EXPECT_FALSE(check.clear({0.6, -0.03, 0.0})) << "towards another one";
}

// However it came there, it goes no further onto a hazard than where its path was planned.
TEST(FootprintCheck, ARoverThatStraysOntoAHazardIsStopped) {
  const Costmap costmap = costmap_of([](Point2 p) {
    return distance(p, {0.05, 0.45}) < 0.01 ? Ground::kHazard : Ground::kFree;
  });
  const auto check = [&](double rover_y_m, double planned_y_m) {
    return FootprintCheck(costmap, kRover, kMarginM, kApproachM, 0.0, {0.0, rover_y_m, 0.0}, {0.0, planned_y_m, 0.0})
        .clear({0.0, rover_y_m, 0.0});
  };
  EXPECT_TRUE(check(-0.08, -0.2)) << "its edge has not reached the cell";
  EXPECT_FALSE(check(-0.03, -0.2)) << "it has, but not the centre of it";
  EXPECT_TRUE(check(0.0, 0.0)) << "a path that leads away from it";
  EXPECT_FALSE(check(0.03, 0.0));
}

TEST(FootprintCheck, ARoverBesideUnknownGroundMayLeaveItButNotEnterIt) {
  const Costmap costmap = costmap_of([](Point2 p) {
    return p.x_m > 0.6 && p.y_m < -0.4 ? Ground::kUnknown : Ground::kFree;  // under a corner of the footprint
  });
  EXPECT_FALSE(check_of(costmap).known({0.0, 0.0, 0.0}));
  const FootprintCheck check = check_of(costmap, {});
  EXPECT_TRUE(check.known({0.0, 0.0, 0.0}));
  EXPECT_TRUE(check.known({-0.05, 0.0, 0.0}));
  EXPECT_TRUE(check.known({0.0, 0.0, 0.1}));
  EXPECT_FALSE(check.known({0.0, -0.05, 0.0}));
}

class VisibilityTest : public testing::Test {
 protected:
  // Only the ground under the rover is known.
  Costmap costmap_ = costmap_of([](Point2 p) { return kRover.distance_m(p) < 0.3 ? Ground::kFree : Ground::kUnknown; });
  FootprintCheck check_ = check_of(costmap_);
  Visibility visibility_{costmap_, check_, ViewArea{}};
};

TEST_F(VisibilityTest, KnownGroundNeedsNoView) {
  EXPECT_TRUE(visibility_.covers({0.0, 0.0, 0.0}));
  EXPECT_TRUE(visibility_.covers({0.15, 0.0, 0.1}));
  EXPECT_FALSE(visibility_.covers({1.0, 0.0, 0.0}));
}

TEST_F(VisibilityTest, GroundAheadIsSeenFromAViewBefore) {
  visibility_.add_view({0.0, 0.0, 0.0});
  EXPECT_TRUE(visibility_.covers({2.9, 0.0, 0.0}));
  EXPECT_FALSE(visibility_.covers({3.3, 0.0, 0.0})) << "beyond the range of the view";
  EXPECT_FALSE(visibility_.covers({2.0, 1.0, 0.0})) << "beside the view";
  EXPECT_FALSE(visibility_.covers({-1.5, 0.0, 0.0})) << "behind";
  visibility_.clear();
  EXPECT_FALSE(visibility_.covers({2.9, 0.0, 0.0}));
}

TEST(Visibility, AHazardHidesTheGroundBehindIt) {
  const auto covers = [](const Rock& rock) {
    const GroundAt rocks = ground_of({rock});
    const Costmap costmap = costmap_of([&](Point2 p) { return p.x_m < 2.6 ? rocks(p) : Ground::kUnknown; });
    const FootprintCheck check = check_of(costmap);
    Visibility visibility(costmap, check, ViewArea{});
    visibility.add_view({});
    return visibility.covers({2.0, 0.0, 0.0});
  };
  EXPECT_TRUE(covers({{2.4, 0.9}, 0.15, 0.3})) << "beside the ground";
  EXPECT_FALSE(covers({{2.4, 0.2}, 0.15, 0.3}));
}

TEST_F(VisibilityTest, SeveralViewsAddUp) {
  visibility_.add_view({0.0, 0.0, 0.0});
  visibility_.add_view({1.0, 0.0, 0.0});
  EXPECT_TRUE(visibility_.covers({3.5, 0.0, 0.0}));
  visibility_.add_view({0.0, 0.0, 0.5 * kPi});
  EXPECT_TRUE(visibility_.covers({0.0, 2.5, 0.5 * kPi}));
}

}  // namespace
}  // namespace rover::planning
