// Hazards, unknown ground and costs of the costmap, against brute force.
#include "path_planner/map/costmap.hpp"

#include <gtest/gtest.h>

#include "test/path_planner/plan_scene.hpp"

namespace rover::planning {
namespace {

using testing_support::certain_belief;
using testing_support::Ground;
using testing_support::planner_config;
using testing_support::uniform;

constexpr double kSideM = 10.0;
constexpr Point2 kMiddle{0.05, 0.05};  // centre of a cell

Costmap costmap_from(const BeliefMap& belief) {
  return Costmap({}, belief, kMiddle, kSideM);
}

// Ground with a box of the kind around the middle, `half_cells` cells to each side of it.
BeliefMap belief_with_box(int half_x, int half_y, Ground kind) {
  return certain_belief([=](Point2 p) {
    const bool inside =
        std::abs(p.x_m - kMiddle.x_m) < 0.1 * half_x + 0.05 && std::abs(p.y_m - kMiddle.y_m) < 0.1 * half_y + 0.05;
    return inside ? kind : Ground::kFree;
  });
}

std::vector<Point2> random_points(std::uint64_t seed, int count) {
  std::mt19937_64 random(seed);
  std::vector<Point2> out;
  for (int i = 0; i < count; ++i) {
    const double x_m = uniform(random, -4.9, 4.9);
    out.push_back({x_m, uniform(random, -4.9, 4.9)});
  }
  return out;
}

Costmap random_costmap(std::uint64_t seed) {
  const std::vector<Point2> rocks = random_points(seed, 60);
  return costmap_from(certain_belief([&](Point2 p) {
    const auto near = [&](Point2 rock) { return distance(rock, p) < 0.15; };
    return std::any_of(rocks.begin(), rocks.end(), near) ? Ground::kHazard : Ground::kFree;
  }));
}

TEST(Costmap, ForBackingUpHazardsThatTheFootprintPassedAreFree) {
  BeliefMap belief = belief_with_box(1, 1, Ground::kHazard);
  belief.mark_driven({kMiddle.x_m - 0.4, kMiddle.y_m - 0.41, 0.0}, planner_config().footprint);
  CostmapConfig config;
  EXPECT_FALSE(Costmap(config, belief, {}, 10.0).hazards().empty()) << "between the wheels of a side";
  config.use = CostmapUse::kBackingUp;
  const std::vector<Hazard> left = Costmap(config, belief, {}, 10.0).hazards();
  EXPECT_FALSE(left.empty());
  for (const Hazard& hazard : left) EXPECT_GT(hazard.p.y_m, kMiddle.y_m) << "beside the footprint";
}

// Seen ground to the north, unseen ground to the south of the driven track.
TEST(Costmap, ForBackingUpALittleBesideTheTrackIsKnown) {
  const double half_width_m = planner_config().footprint.half_width_m;
  BeliefMap belief = certain_belief([](Point2 p) { return p.y_m > 0.0 ? Ground::kFree : Ground::kUnknown; });
  for (double x_m = -3.0; x_m <= 3.0; x_m += 0.05) belief.mark_driven({x_m, 0.0, 0.0}, planner_config().footprint);
  const auto unknown = [&](CostmapUse use, double beside_m) {
    CostmapConfig config;
    config.use = use;
    return Costmap(config, belief, {}, kSideM).unknown({0.05, std::copysign(half_width_m, beside_m) + beside_m});
  };
  EXPECT_TRUE(unknown(CostmapUse::kGoingOn, -0.15));
  EXPECT_FALSE(unknown(CostmapUse::kBackingUp, -0.15));
  EXPECT_TRUE(unknown(CostmapUse::kBackingUp, -0.4));
  EXPECT_FALSE(unknown(CostmapUse::kBackingUp, 0.4));
  EXPECT_FALSE(unknown(CostmapUse::kBackingUpOnTrack, -0.15));
  EXPECT_TRUE(unknown(CostmapUse::kBackingUpOnTrack, 0.4)) << "seen, but not driven";
}

TEST(Costmap, ListsHazardsRowByRow) {
  const Costmap costmap = random_costmap(1);
  const std::vector<Hazard>& hazards = costmap.hazards();
  ASSERT_GT(hazards.size(), 100u);
  for (size_t i = 1; i < hazards.size(); ++i)
    EXPECT_LT(costmap.cell_of(hazards[i - 1].p), costmap.cell_of(hazards[i].p));
}

TEST(Costmap, ListsTheHazardsNearAPoint) {
  const Costmap costmap = random_costmap(2);
  for (const Point2& p : random_points(3, 100))
    for (const double reach_m : {0.0, 0.3, 1.2, 20.0}) {
      size_t within = 0;
      size_t listed = 0;
      for (const auto& [h, low] : costmap.hazards()) within += std::abs(h.y_m - p.y_m) <= reach_m ? 1 : 0;
      for (const auto& [h, low] : costmap.hazards_near(p, reach_m)) {
        listed += std::abs(h.y_m - p.y_m) <= reach_m ? 1 : 0;
        EXPECT_LE(std::abs(h.y_m - p.y_m), reach_m + costmap.cell_m());
      }
      EXPECT_EQ(listed, within);
    }
}

TEST(Costmap, DistancesReachToTheNearestCentreOfAHazardCell) {
  const Costmap costmap = random_costmap(4);
  for (const Point2& p : random_points(5, 300)) {
    const Point2 center = costmap.center_of(costmap.cell_of(p));
    double nearest = kInfinity;
    for (const Hazard& h : costmap.hazards()) nearest = std::min(nearest, distance(h.p, center));
    EXPECT_NEAR(costmap.hazard_distance_m(p), nearest, 1e-6);
  }
  EXPECT_TRUE(std::isinf(costmap.hazard_distance_m(Point2{6.0, 0.0})));
}

TEST(Costmap, CoversASquareAroundTheRover) {
  const Costmap costmap = costmap_from(belief_with_box(0, 0, Ground::kFree));
  EXPECT_TRUE(costmap.contains({4.9, -4.9}));
  EXPECT_NEAR(costmap.inside_m({4.0, 0.0}), 1.0, 1e-9);
  EXPECT_FALSE(costmap.unknown(Point2{4.9, 0.0}));
  EXPECT_FALSE(costmap.contains({5.1, 0.0}));
  EXPECT_LT(costmap.inside_m({5.1, 0.0}), 0.0);
  EXPECT_TRUE(costmap.unknown(Point2{5.1, 0.0}));
}

TEST(Costmap, FillsUnknownCellsAmongKnownOnes) {
  for (const int length : {0, 3, 10}) {
    EXPECT_FALSE(costmap_from(belief_with_box(0, length, Ground::kUnknown)).unknown(kMiddle)) << length;
    EXPECT_FALSE(costmap_from(belief_with_box(length, 0, Ground::kUnknown)).unknown(kMiddle)) << length;
  }
  EXPECT_TRUE(costmap_from(belief_with_box(1, 1, Ground::kUnknown)).unknown(kMiddle));
}

TEST(Costmap, MeasuresTheDistanceToUnknownGround) {
  const Costmap costmap = costmap_from(belief_with_box(2, 2, Ground::kUnknown));
  EXPECT_EQ(costmap.unknown_distance_m(kMiddle), 0.0);
  EXPECT_NEAR(costmap.unknown_distance_m({kMiddle.x_m + 1.2, kMiddle.y_m}), 1.0, 1e-6);
  EXPECT_EQ(costmap.unknown_distance_m({6.0, 0.0}), 0.0);
}

// Ground that was seen from far, and could not be measured from near.
BeliefMap belief_with_unmeasured_strip(int half_x, int half_y) {
  BeliefMap belief = belief_with_box(half_x, half_y, Ground::kUnknown);
  belief.cells().for_each([](CellIndex, CellBelief& cell) {
    if (!cell.known) cell = {.known = true, .unmeasured = 255};
  });
  return belief;
}

TEST(Costmap, WideUnmeasuredGroundIsAHazardAndANarrowStripIsNot) {
  const Costmap narrow = costmap_from(belief_with_unmeasured_strip(1, 10));
  EXPECT_TRUE(narrow.hazards().empty());
  EXPECT_FALSE(narrow.unknown(kMiddle));
  const Costmap wide = costmap_from(belief_with_unmeasured_strip(2, 10));
  EXPECT_EQ(wide.hazards().size(), 5u * 21u);
  EXPECT_TRUE(wide.unknown(kMiddle));
}

TEST(Costmap, DifficultGroundCostsAsFarAsTheWheelsReach) {
  const CostmapConfig config;
  BeliefMap belief = belief_with_box(0, 0, Ground::kFree);
  belief.cells().at(belief.cells().index_of(kMiddle.x_m, kMiddle.y_m)).cost = 0.6F;
  const Costmap costmap = costmap_from(belief);
  const auto cost = [&, costs = costmap.costs()](double dx_m, double dy_m) {
    return costs[costmap.cell_of({kMiddle.x_m + dx_m, kMiddle.y_m + dy_m})];
  };
  const double easy = cost(3.0, 3.0);
  EXPECT_NEAR(easy, 1.0, 0.01);
  for (const auto& [dx_m, dy_m] : {std::pair{0.0, 0.0}, {0.4, 0.0}, {-0.4, 0.0}, {0.0, 0.4}, {0.4, -0.4}})
    EXPECT_NEAR(cost(dx_m, dy_m), easy + 0.6 * config.difficulty_cost, 1e-5) << dx_m << " " << dy_m;
  EXPECT_NEAR(cost(0.5, 0.0), easy, 1e-6);
  EXPECT_NEAR(cost(0.0, -0.5), easy, 1e-6);
}

TEST(Costmap, AProbableHazardCostsMoreAndUnknownGroundALittle) {
  const CostmapConfig config;
  BeliefMap belief = belief_with_box(2, 2, Ground::kUnknown);
  const Costmap unknown = costmap_from(belief);
  EXPECT_NEAR(unknown.costs()[unknown.cell_of(kMiddle)], 1.0 + config.unknown_cost, 0.02);
  CellBelief& cell = belief.cells().at(belief.cells().index_of(2.05, 2.05));
  cell.evidence = static_cast<float>(BeliefConfig{}.hit);
  const Costmap probable = costmap_from(belief);
  EXPECT_TRUE(probable.hazards().empty());
  EXPECT_NEAR(probable.costs()[probable.cell_of({2.05, 2.05})], 1.0 + config.hazard_cost * belief.probability(cell),
              1e-5);
}

}  // namespace
}  // namespace rover::planning
