// What the frames of both cameras make of a cell: evidence for a hazard, ground that cannot be measured, and what is
// forgotten.
#include "path_planner/map/belief_map.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "path_planner/map/costmap.hpp"
#include "test/path_planner/rock_world.hpp"

namespace rover::planning {
namespace {

constexpr Point2 kRock{2.05, 0.25};
constexpr Pose2 kNear{0.5, 0.0, 0.0};  // 1.6 m from the rock
constexpr Pose2 kFar{-1.5, 0.0, 0.0};  // 3.6 m
constexpr double kHazardProbability = 0.5;

// The shape of hazard_detector's grid.
HazardGrid frame_of(std::uint8_t value) {
  return {{0, 0.1, 0.5, -2.0, 35, 40, std::vector<std::uint8_t>(1400, value)}};
}

HazardGrid frame_with(std::uint8_t at_rock, Point2 rock_in_body, std::uint8_t elsewhere) {
  HazardGrid grid = frame_of(elsewhere);
  const int ix = static_cast<int>(std::floor((rock_in_body.x_m - grid.origin_x_m) / grid.cell_m));
  const int iy = static_cast<int>(std::floor((rock_in_body.y_m - grid.origin_y_m) / grid.cell_m));
  grid.cells[static_cast<size_t>(iy) * grid.cells_x + ix] = at_rock;
  return grid;
}

class BeliefMapTest : public testing::Test {
 protected:
  void SetUp() override { belief_.move_to({0.0, 0.0}); }

  // Frames that see free ground, but `value` at the rock.
  void see(std::uint8_t value, int times = 1, const Pose2& from = kNear) {
    for (int i = 0; i < times; ++i)
      belief_.add(frame_with(value, to_body(from, kRock), HazardGrid::kFree), from_planar(from));
  }
  // Frames with the same value everywhere.
  void see_everywhere(std::uint8_t value, int times = 1, const Pose2& from = {}) {
    for (int i = 0; i < times; ++i) belief_.add(frame_of(value), from_planar(from));
  }
  // A map of the NavCam with the same cost everywhere, made `range_m` from the rock.
  void see_cost(std::uint8_t cost, double range_m, double dead_reckoned_m = 0.0) {
    TraversabilityGrid map{{0, 0.1, -10.0, -10.0, 200, 200, std::vector<std::uint8_t>(40000, cost)}};
    testing_support::complete(map);
    map.height_m.assign(40000, height_m_);
    belief_.add_drift(dead_reckoned_m);
    see_map(map, range_m);
  }
  void see_map(const TraversabilityGrid& map, double range_m) {
    belief_.add(map, {kRock.x_m - range_m, kRock.y_m, 0.0}, testing_support::planner_config().footprint);
  }
  const CellBelief& at(Point2 p) const { return belief_.cells().get(belief_.cells().index_of(p.x_m, p.y_m)); }
  double probability() const { return belief_.probability(at(kRock)); }
  bool is_hazard() const { return probability() >= kHazardProbability; }
  size_t hazards() const { return Costmap({}, belief_, {}, 12.0).hazards().size(); }

  BeliefConfig config_;
  BeliefMap belief_{config_};
  float height_m_ = 0.0F;  // of the NavCam's map
};

TEST_F(BeliefMapTest, OneHitIsNotAHazardYetAndTwoAre) {
  see(HazardGrid::kObstacle);
  EXPECT_FALSE(is_hazard());
  see(HazardGrid::kHole);
  EXPECT_TRUE(is_hazard());
}

// Turned by 45 degrees, two cells of the frame may fall into one of the map.
TEST_F(BeliefMapTest, HitsCountOncePerFrame) {
  see_everywhere(HazardGrid::kObstacle, 1, {0.0, 0.0, to_rad(45.0)});
  belief_.cells().for_each([&](CellIndex, const CellBelief& cell) { ASSERT_LE(cell.evidence, config_.hit); });
}

TEST_F(BeliefMapTest, MissesCountFullyFromNearAndLessFromFar) {
  see(HazardGrid::kFree, 1, kNear);
  EXPECT_NEAR(at(kRock).evidence, -config_.miss, 1e-6);
  see(HazardGrid::kFree, 1, kFar);
  const double far_m = distance(kRock, position(kFar));
  EXPECT_NEAR(at(kRock).evidence, -config_.miss * (1.0 + config_.near_range_m / far_m), 1e-6);
}

TEST_F(BeliefMapTest, ARockThatIsNoLongerSeenFromNearIsCleared) {
  see(HazardGrid::kObstacle, 100);
  EXPECT_NEAR(at(kRock).evidence, config_.max_evidence, 1e-6);
  see(HazardGrid::kFree, 3);
  EXPECT_FALSE(is_hazard());
}

TEST_F(BeliefMapTest, ARockOnGroundThatWasLongFreeIsFound) {
  see(HazardGrid::kFree, 100);
  EXPECT_NEAR(at(kRock).evidence, -config_.max_evidence, 1e-6);
  see(HazardGrid::kObstacle, 4);
  EXPECT_TRUE(is_hazard());
}

TEST_F(BeliefMapTest, ARockThatFlipsBetweenFramesStaysAHazard) {
  for (int i = 0; i < 3; ++i) {
    see(HazardGrid::kObstacle);
    see(HazardGrid::kFree);
  }
  for (int i = 0; i < 50; ++i) {
    see(HazardGrid::kObstacle);
    EXPECT_TRUE(is_hazard()) << i;
    see(HazardGrid::kFree);
    EXPECT_TRUE(is_hazard()) << i;
  }
}

TEST_F(BeliefMapTest, UnseenFramesAndMarginsClearNoHazard) {
  see(HazardGrid::kObstacle, 2);
  see_everywhere(HazardGrid::kUnseen, 50, kNear);
  see_everywhere(HazardGrid::kMargin, 50, kNear);
  EXPECT_TRUE(is_hazard());
}

TEST_F(BeliefMapTest, OnlyGroundThatTheFrameSawIsKnown) {
  see_everywhere(HazardGrid::kUnseen);
  EXPECT_FALSE(at({2.05, 0.05}).known);
  for (const std::uint8_t value : {HazardGrid::kFree, HazardGrid::kMargin, HazardGrid::kObstacle, HazardGrid::kHole}) {
    belief_.cells().clear();
    see_everywhere(value);
    EXPECT_TRUE(at({2.05, 0.05}).known) << int(value);
    EXPECT_FALSE(at({-1.05, 0.05}).known) << int(value);
  }
}

TEST_F(BeliefMapTest, AFrameIsInsertedAtThePoseOfItsExposure) {
  const Pose2 from{1.3, -2.2, 2.0};
  const Point2 in_body{2.05, -0.75};
  belief_.add(frame_with(HazardGrid::kObstacle, in_body, HazardGrid::kUnseen), from_planar(from));
  EXPECT_GT(at(from_body(from, in_body)).evidence, 0.0);
  int hits = 0;
  belief_.cells().for_each([&](CellIndex, const CellBelief& cell) { hits += cell.evidence > 0.0 ? 1 : 0; });
  EXPECT_EQ(hits, 1);
}

// Pitched nose down, the ground ahead lies nearer in the plane than in body axes.
TEST_F(BeliefMapTest, AFrameIsInsertedWithTheAttitudeOfItsExposure) {
  const double pitch = to_rad(10.0);
  const Eigen::Isometry3d T = make_pose(rotation_from_rpy(0.0, pitch, 0.0), {0.0, 0.0, 0.0});
  belief_.add(frame_with(HazardGrid::kObstacle, {3.05, 0.05}, HazardGrid::kFree), ground_pose(T, 0.62));
  EXPECT_GT(at({3.05 * std::cos(pitch) - 0.62 * std::sin(pitch), 0.05}).evidence, 0.0);
}

TEST_F(BeliefMapTest, HazardsBesideTheRoverAreKeptWhileItTurns) {
  see(HazardGrid::kObstacle, 2, {});
  for (int deg = 100; deg <= 260; deg += 10) see_everywhere(HazardGrid::kFree, 1, {0.0, 0.0, to_rad(deg)});
  EXPECT_TRUE(is_hazard());
}

TEST_F(BeliefMapTest, DrivenGroundIsFreeWhateverWasSeenThere) {
  const Footprint footprint = testing_support::planner_config().footprint;
  see(HazardGrid::kObstacle, 5);
  see_cost(TraversabilityGrid::kImpassable, 2.0);
  belief_.mark_driven({kRock.x_m, kRock.y_m + footprint.half_width_m + 0.05, 0.0}, footprint);
  EXPECT_TRUE(is_hazard()) << "beside the driven ground";
  belief_.mark_driven({kRock.x_m - 0.4, kRock.y_m - 0.41, 0.0}, footprint);
  EXPECT_TRUE(is_hazard()) << "between the wheels of a side";
  belief_.mark_driven({kRock.x_m - 0.75, kRock.y_m - 0.41, 0.0}, footprint);
  EXPECT_EQ(probability(), 0.0);
  EXPECT_TRUE(at(kRock).known);
  see(HazardGrid::kObstacle, 5);
  EXPECT_EQ(probability(), 0.0);
}

TEST_F(BeliefMapTest, AHazardIsLowOnlyIfCamerasSaySo) {
  see(HazardGrid::kObstacle, 2);
  EXPECT_FALSE(belief_.low(at(kRock)));
  see(HazardGrid::kLow, 4);
  EXPECT_FALSE(belief_.low(at(kRock))) << "a look that finds it tall weighs more";
  see(HazardGrid::kLow, 2);
  EXPECT_TRUE(belief_.low(at(kRock)));
  see_cost(TraversabilityGrid::kImpassable, 2.0);
  EXPECT_FALSE(belief_.low(at(kRock)));
}

// Its top may lie above the picture.
TEST_F(BeliefMapTest, FromAfarAnObstacleMayBeLowUntilItIsSeenToBe) {
  const Pose2 far{-1.3, 0.0, 0.0};  // 3.4 m from the rock
  see(HazardGrid::kObstacle, 10, far);
  EXPECT_FALSE(belief_.low(at(kRock))) << "unknown counts as tall";
  see(HazardGrid::kLow, 1, far);
  EXPECT_TRUE(belief_.low(at(kRock)));
  see(HazardGrid::kObstacle, 1);
  EXPECT_FALSE(belief_.low(at(kRock)));
}

TEST_F(BeliefMapTest, BetweenTheWheelsALowHazardStaysOne) {
  const Footprint footprint = testing_support::planner_config().footprint;
  see(HazardGrid::kObstacle, 3);
  belief_.mark_driven({kRock.x_m, kRock.y_m, 0.0}, footprint);
  EXPECT_TRUE(is_hazard());
  EXPECT_TRUE(belief_.low(at(kRock))) << "the body passed over it";
  belief_.mark_driven({kRock.x_m, kRock.y_m + 0.41, 0.0}, footprint);
  EXPECT_EQ(probability(), 0.0) << "a wheel drove over it";
}

TEST_F(BeliefMapTest, UnderTheRoverTheNavCamsMapChangesNothing) {
  see(HazardGrid::kObstacle, 3);
  belief_.mark_driven({kRock.x_m, kRock.y_m, 0.0}, testing_support::planner_config().footprint);
  see_cost(TraversabilityGrid::kImpassable, 0.0);
  EXPECT_TRUE(belief_.low(at(kRock)));
  see_cost(TraversabilityGrid::kImpassable, 1.5);
  EXPECT_FALSE(belief_.low(at(kRock))) << "it is seen again";
}

TEST_F(BeliefMapTest, TheNewestHeightStaysAlsoUnderTheRover) {
  see_cost(0, 1.5);
  EXPECT_EQ(at(kRock).height_m, 0.0F);
  height_m_ = 0.3F;
  belief_.mark_driven({kRock.x_m, kRock.y_m, 0.0}, testing_support::planner_config().footprint);
  see_cost(TraversabilityGrid::kUnknown, 0.0);
  EXPECT_EQ(at(kRock).height_m, 0.3F);
  height_m_ = CellBelief::kNoHeight;
  belief_.mark_driven({kRock.x_m, kRock.y_m + 0.41, 0.0}, testing_support::planner_config().footprint);
  see_cost(0, 1.5);
  EXPECT_EQ(at(kRock).height_m, 0.3F);
}

TEST_F(BeliefMapTest, DrivenGroundNeedsNoMeasurement) {
  belief_.mark_driven({0.8, -0.36, 0.0}, testing_support::planner_config().footprint);
  see_everywhere(HazardGrid::kUnseen, 2 * config_.unmeasured_frames);
  EXPECT_FALSE(belief_.unmeasurable(at({1.55, 0.05})));
}

TEST_F(BeliefMapTest, CertifiedGroundIsKnownAndKeepsItsHazards) {
  const Point2 center{2.0, 0.0};
  see_everywhere(HazardGrid::kUnseen);
  belief_.mark_known(center, 1.5);
  belief_.cells().for_each([&](CellIndex i, const CellBelief& cell) {
    const Point2 p{belief_.cells().center_x_m(i), belief_.cells().center_y_m(i)};
    EXPECT_EQ(cell.known, distance(p, center) <= 1.5);
  });
  EXPECT_EQ(hazards(), 0u);
  see(HazardGrid::kObstacle, 2);
  belief_.mark_known(center, 1.5);
  EXPECT_TRUE(is_hazard());
}

TEST_F(BeliefMapTest, UnmeasuredGroundInViewNearbyBecomesAHazard) {
  const Point2 drop{1.55, 0.05};
  see_everywhere(HazardGrid::kUnseen, config_.unmeasured_frames - 1);
  EXPECT_FALSE(belief_.unmeasurable(at(drop)));
  EXPECT_EQ(hazards(), 0u);
  see_everywhere(HazardGrid::kUnseen);
  EXPECT_TRUE(belief_.unmeasurable(at(drop)));
  EXPECT_GT(hazards(), 0u);
  EXPECT_FALSE(belief_.unmeasurable(at({3.55, 0.05}))) << "too far to be sure";
  EXPECT_FALSE(belief_.unmeasurable(at({1.55, 1.55}))) << "not in view";
  see_everywhere(HazardGrid::kFree);
  EXPECT_FALSE(belief_.unmeasurable(at(drop)));
  EXPECT_EQ(hazards(), 0u);
}

TEST_F(BeliefMapTest, GroundThatIsSurelyFreeMayBeUnmeasuredFromNear) {
  const Point2 shadow{1.55, 0.05};
  for (const int looks : {1, 8}) {
    belief_.cells().clear();
    see_everywhere(HazardGrid::kFree, looks, {-1.5, 0.0, 0.0});
    see_everywhere(HazardGrid::kUnseen, 300);
    EXPECT_EQ(belief_.unmeasurable(at(shadow)), looks == 1) << looks;
  }
  EXPECT_EQ(hazards(), 0u);
}

TEST_F(BeliefMapTest, GroundThatTheNavCamSawFreeMayBeUnmeasuredByTheLocCam) {
  const Point2 shadow{1.55, 0.05};
  struct Look {
    std::uint8_t cost;
    double range_m;
    bool unmeasurable;
  };
  for (const Look& look : {Look{0, 2.0, false}, Look{0, 6.0, false}, Look{120, 2.0, false}, Look{120, 9.0, true},
                           Look{240, 2.0, true}, Look{TraversabilityGrid::kImpassable, 2.0, true}}) {
    belief_.cells().clear();
    see_cost(look.cost, look.range_m + kRock.x_m - shadow.x_m);
    see_everywhere(HazardGrid::kUnseen, 300);
    EXPECT_EQ(belief_.unmeasurable(at(shadow)), look.unmeasurable) << int(look.cost) << " at " << look.range_m << " m";
  }
}

TEST_F(BeliefMapTest, OneMeasurementBeforeTheLastFrameStartsTheCountAgain) {
  see_everywhere(HazardGrid::kUnseen, config_.unmeasured_frames - 1);
  see_everywhere(HazardGrid::kFree);
  see_everywhere(HazardGrid::kUnseen, config_.unmeasured_frames - 1);
  EXPECT_FALSE(belief_.unmeasurable(at({1.55, 0.05})));
}

TEST_F(BeliefMapTest, OnlyALookFromAsNearClearsUnmeasuredGround) {
  const Point2 dust{1.95, 0.05};
  for (int i = 0; i < config_.unmeasured_frames; ++i) see_everywhere(HazardGrid::kUnseen, 1, {0.1 * i, 0.0, 0.0});
  const double nearest_x_m = 0.1 * (config_.unmeasured_frames - 1);
  for (const std::uint8_t seen : {HazardGrid::kFree, HazardGrid::kMargin}) {
    see_everywhere(seen, 1, {nearest_x_m - 0.2, 0.0, 0.0});
    EXPECT_TRUE(belief_.unmeasurable(at(dust))) << int(seen);
  }
  see_everywhere(HazardGrid::kFree, 1, {nearest_x_m, 0.0, 0.0});
  EXPECT_FALSE(belief_.unmeasurable(at(dust)));
}

TEST_F(BeliefMapTest, GroundHiddenBehindAnObstacleIsNotUnmeasured) {
  HazardGrid grid = frame_of(HazardGrid::kUnseen);
  for (int iy = 15; iy < 25; ++iy) grid.cells[static_cast<size_t>(iy) * grid.cells_x + 6] = HazardGrid::kObstacle;
  for (int i = 0; i < 3 * config_.unmeasured_frames; ++i) belief_.add(grid, from_planar({}));
  EXPECT_FALSE(belief_.unmeasurable(at({1.65, 0.05})));
}

TEST_F(BeliefMapTest, ASlopeCostsAndIsNoStep) {
  TraversabilityGrid slope{{0, 0.1, -10.0, -10.0, 200, 200, std::vector<std::uint8_t>(40000, 240)}};
  testing_support::complete(slope);
  slope.step_percent.assign(40000, 10);
  see_map(slope, 2.0);
  EXPECT_GT(at(kRock).cost, 0.5F);
  const double on_slope = probability();
  belief_.cells().clear();
  see_cost(0, 2.0);
  EXPECT_EQ(on_slope, probability());
}

TEST_F(BeliefMapTest, ProbabilityGrowsWithTheStepsOfTheNavCamsMap) {
  double last = 0.0;
  for (const int cost : {0, 120, 180, 220, 252, int(TraversabilityGrid::kLow), int(TraversabilityGrid::kImpassable)}) {
    belief_.cells().clear();
    see_cost(static_cast<std::uint8_t>(cost), 2.0);
    EXPECT_GE(probability(), last) << cost;
    EXPECT_EQ(is_hazard(), cost >= TraversabilityGrid::kLow) << cost;
    last = probability();
  }
  EXPECT_GT(last, 0.9);
}

TEST_F(BeliefMapTest, UnknownCellsOfTheNavCamsMapChangeNothing) {
  see_cost(TraversabilityGrid::kUnknown, 2.0);
  EXPECT_FALSE(at(kRock).known);
  see_cost(TraversabilityGrid::kImpassable, 2.0);
  see_cost(TraversabilityGrid::kUnknown, 2.0);
  EXPECT_TRUE(is_hazard());
}

TEST_F(BeliefMapTest, AFarLookOfTheNavCamDoesNotOutweighANearOne) {
  see_cost(TraversabilityGrid::kImpassable, 1.5);
  see_cost(60, 9.0);
  EXPECT_TRUE(is_hazard());
  belief_.cells().clear();
  see_cost(0, 1.5);
  see_cost(TraversabilityGrid::kImpassable, 9.0);
  EXPECT_FALSE(is_hazard());
}

TEST_F(BeliefMapTest, AFarLookThatSeesNoRockDoesNotOutweighANearOne) {
  see_cost(TraversabilityGrid::kImpassable, 1.5);
  see_cost(0, 9.0);
  EXPECT_TRUE(is_hazard());
}

TEST_F(BeliefMapTest, ANearLookOfTheNavCamOutweighsAFarOne) {
  see_cost(TraversabilityGrid::kImpassable, 9.0);
  see_cost(60, 1.5);
  EXPECT_FALSE(is_hazard());
  belief_.cells().clear();
  see_cost(60, 9.0);
  see_cost(TraversabilityGrid::kImpassable, 1.5);
  EXPECT_TRUE(is_hazard());
}

// Odom drifts under the map: what was seen before the wheels drove alone lies elsewhere.
TEST_F(BeliefMapTest, WheelsAloneWeakenLooksThatNoNewMapCovers) {
  see(HazardGrid::kObstacle, 4);
  const double before = probability();
  belief_.add_drift(2.0);
  EXPECT_LT(probability(), before - 0.05);
}

TEST_F(BeliefMapTest, AfterWheelsAloneANewMapReplacesOlderLooks) {
  for (const bool wheels_alone : {false, true}) {
    belief_.cells().clear();
    see(HazardGrid::kObstacle, 2);
    for (int i = 0; i < 10; ++i) see_cost(TraversabilityGrid::kImpassable, 2.0);
    ASSERT_TRUE(is_hazard());
    for (int i = 0; i < 6; ++i) see_cost(0, 4.0, wheels_alone ? 0.5 : 0.0);
    EXPECT_EQ(is_hazard(), !wheels_alone);
  }
}

TEST_F(BeliefMapTest, LocCamMissesOverruleAnImpassableCellOfTheNavCam) {
  see_cost(TraversabilityGrid::kImpassable, 2.0);
  see(HazardGrid::kFree, 3);
  EXPECT_TRUE(is_hazard());
  see(HazardGrid::kFree);
  EXPECT_FALSE(is_hazard());
}

TEST_F(BeliefMapTest, LocCamHitsOverruleFreeGroundOfTheNavCam) {
  see_cost(0, 2.0);
  see(HazardGrid::kObstacle, 2);
  EXPECT_TRUE(is_hazard());
}

TEST_F(BeliefMapTest, HazardsAreKeptOutOfViewAndForgottenOutsideTheGrid) {
  see(HazardGrid::kObstacle, 2);
  const double half_m = 0.5 * config_.cells * BeliefConfig::kCellM;
  for (double x = 0.0; x < kRock.x_m + half_m - 0.2; x += 0.1) {
    belief_.move_to({x, 0.0});
    ASSERT_TRUE(is_hazard()) << x;
  }
  belief_.move_to({kRock.x_m + half_m + 0.2, 0.0});
  belief_.move_to({0.0, 0.0});
  EXPECT_FALSE(is_hazard());
  EXPECT_FALSE(at(kRock).known);
}

TEST(InputGrid, CorruptGridsAreRefusedWithAReason) {
  EXPECT_EQ(frame_of(HazardGrid::kLow).fault(), "");
  const std::vector<std::function<void(InputGrid&)>> faults = {
      [](InputGrid& g) { g.cells_x = 0; },
      [](InputGrid& g) { g.cells_y = -40; },
      [](InputGrid& g) { g.cells_x = g.cells_y = 1 << 16; },
      [](InputGrid& g) { g.cells.pop_back(); },
      [](InputGrid& g) { g.cell_m = kNaN; },
      [](InputGrid& g) { g.cell_m = 0.0; },
      [](InputGrid& g) { g.origin_x_m = kInfinity; },
      [](InputGrid& g) { g.origin_y_m = kNaN; },
      [](InputGrid& g) { g.cells[7] = HazardGrid::kLow + 1; },
  };
  for (size_t i = 0; i < faults.size(); ++i) {
    HazardGrid grid = frame_of(HazardGrid::kFree);
    faults[i](grid);
    EXPECT_NE(grid.fault(), "") << i;
  }
  const InputGrid unknown{0, 0.1, 0.0, 0.0, 1, 1, {TraversabilityGrid::kUnknown}};
  EXPECT_EQ(TraversabilityGrid({unknown, {0}, {kNaN}}).fault(), "");
  EXPECT_NE(TraversabilityGrid({unknown, {}, {kNaN}}).fault(), "");
  EXPECT_NE(TraversabilityGrid({unknown, {0}, {}}).fault(), "");
}

TEST(InputGrid, ReadsTheCellAtAPointAndNothingOutside) {
  const InputGrid grid{0, 0.1, 5.0, -3.0, 2, 1, {7, 9}};
  EXPECT_EQ(grid.at({5.05, -2.95}), 7);
  EXPECT_EQ(grid.at({5.15, -2.95}), 9);
  for (const Point2 p : {Point2{4.99, -2.95}, Point2{5.21, -2.95}, Point2{5.05, -3.01}, Point2{kNaN, -2.95}})
    EXPECT_EQ(grid.at(p), InputGrid::kOutside);
}

}  // namespace
}  // namespace rover::planning
