#include "tools/report/map_fidelity.hpp"

#include <gtest/gtest.h>

#include "known_run.hpp"
#include "tools/report/convert.hpp"
#include "tools/report/true_relief.hpp"

namespace rover::report {
namespace {

constexpr double kLocCamX = 0.527;

// Boxes on a plane of this slope along x.
struct BoxWorld {
  double slope = 0.0;
  struct Block {
    double x_m, y_m, half_m, height_m;
  };
  std::vector<Block> blocks;

  double ground_m(double x_m) const { return slope * x_m; }
  double height_m(double x_m, double y_m) const {
    double top = 0.0;
    for (const Block& b : blocks)
      if (std::abs(x_m - b.x_m) < b.half_m && std::abs(y_m - b.y_m) < b.half_m) top = std::max(top, b.height_m);
    return ground_m(x_m) + top;
  }
  TrueWorld truth() const {
    TrueWorld world;
    for (const Block& b : blocks) world.rocks.push_back({b.x_m, b.y_m, b.half_m, b.height_m});
    world.height_m = [this](double x, double y) { return height_m(x, y); };
    world.ground_m = [this](double x, double) { return ground_m(x); };
    return world;
  }
};

// A HAZARDS map of 4 m x 4 m ahead; `impassable` takes a point in body.
template <class F>
PassabilityMap map_of(double t_s, F&& impassable) {
  PassabilityMap map{t_s, 0.1, 0.0, -2.0, 40, 40, {}};
  for (int i = 0; i < 1600; ++i) {
    const bool closed = impassable((i % 40 + 0.5) * 0.1, -2.0 + (i / 40 + 0.5) * 0.1);
    map.cells.push_back(closed ? PassabilityMap::kImpassable : PassabilityMap::kPassable);
  }
  return map;
}

// A cell of 0.1 m that touches the block by the true pose at x.
auto perfect(const BoxWorld& world, double rover_x_m) {
  return [&world, rover_x_m](double x, double y) {
    return std::any_of(world.blocks.begin(), world.blocks.end(), [&](const BoxWorld::Block& b) {
      return std::abs(rover_x_m + x - b.x_m) < b.half_m + 0.05 && std::abs(y - b.y_m) < b.half_m + 0.05;
    });
  };
}

MapFidelities fidelities(const RunRecord& run, const BoxWorld& world) {
  const TrueWorld truth = world.truth();
  return map_fidelities(run, TrueTrack(run.truth), drive_window(run), Footprint{}, truth);
}

FidelityCount total(const MapFidelity& map, size_t height) {
  FidelityCount sum;
  for (const FidelityCount& count : map.counts[height]) {
    sum.looks += count.looks;
    sum.impassable += count.impassable;
    sum.cells += count.cells;
  }
  return sum;
}

TEST(TrueRelief, KeepsTheHeightOfARockOnASlope) {
  const BoxWorld world{0.25, {{3.0, 1.0, 0.2, 0.30}}};
  const TrueWorld truth = world.truth();
  TrueRelief relief(truth);
  EXPECT_NEAR(relief.at({3.03, 1.02}).rise_m, 0.30, 0.01);
  EXPECT_NEAR(relief.at({3.03, 1.02}).tall_ratio, 1.0, 1e-6);
  EXPECT_NEAR(relief.at({2.02, 1.02}).rise_m, 0.0, 0.01);
  EXPECT_NEAR(relief.at({-7.03, -40.02}).rise_m, 0.0, 0.01) << "also at negative coordinates";
  EXPECT_NEAR(relief.at({-7.025, -40.02}).ground_m, -0.25 * 7.025, 1e-6);
}

TEST(TrueRelief, CountsABumpOfTheGroundLikeARock) {
  TrueWorld truth;
  truth.ground_m = [](double x, double y) { return std::hypot(x - 1.0, y - 1.0) < 0.2 ? 0.2 : 0.0; };
  truth.height_m = truth.ground_m;
  TrueRelief relief(truth);
  EXPECT_GT(relief.at({1.0, 1.0}).rise_m, 0.15);
}

TEST(MapFidelity, PerfectMapIsImpassableWhereTheSurfaceIsHigh) {
  // Block edges on cell edges of the first map: 4 x 4 cells of the block.
  const BoxWorld world{0.0, {{2.0, 0.0, 0.2, 0.17}}};
  RunRecord run = straight_run(10.0);
  run.hazard_maps = {map_of(5.0, [](double x, double y) { return std::abs(x - 2.0) < 0.2 && std::abs(y) < 0.2; })};
  const auto map = fidelities(run, world).hazards;
  ASSERT_TRUE(map);
  EXPECT_EQ(map->maps, 1);
  EXPECT_EQ(total(*map, 3).looks, 16);
  EXPECT_EQ(total(*map, 3).impassable, 16);
  EXPECT_EQ(total(*map, 0).looks, 1600 - 16);
  EXPECT_EQ(total(*map, 0).impassable, 0);
  EXPECT_NEAR(map->area_ratio, 1.0, 1e-6);
  EXPECT_NEAR(map->ideal_area_ratio, 1.0, 1e-6);
  // All 16 cells are 1.3 to 1.7 m ahead of the camera.
  EXPECT_EQ(map->counts[3][1].looks, 16);
}

TEST(MapFidelity, HeightClassesAreThoseOfTheTrueSurface) {
  const std::vector<double> heights = {0.03, 0.07, 0.12, 0.17, 0.30};
  for (size_t i = 0; i < heights.size(); ++i) {
    const BoxWorld world{0.1, {{2.0, 0.0, 0.2, heights[i]}}};
    RunRecord run = straight_run(10.0);
    for (TruthSample& sample : run.truth) sample.T_map_body.translation().z() = 0.62 + 0.1 * 2.0;
    run.hazard_maps = {map_of(5.0, [](double x, double y) { return std::abs(x - 2.0) < 0.2 && std::abs(y) < 0.2; })};
    const auto map = fidelities(run, world).hazards;
    EXPECT_EQ(total(*map, i).impassable, 16) << heights[i];
  }
}

TEST(MapFidelity, InflatedMapHasItsAreaRatio) {
  const BoxWorld world{0.0, {{2.0, 0.0, 0.2, 0.25}}};
  RunRecord run = straight_run(10.0);
  run.hazard_maps = {map_of(5.0, [](double x, double y) { return std::abs(x - 2.0) < 0.4 && std::abs(y) < 0.4; })};
  const auto map = fidelities(run, world).hazards;
  EXPECT_NEAR(map->area_ratio, 4.0, 1e-6);
  EXPECT_NEAR(total(*map, 0).ratio(), 48.0 / (1600 - 16), 1e-9);
}

TEST(MapFidelity, LocalizationErrorDoesNotCount) {
  const BoxWorld world{0.0, {{4.0, 0.0, 0.2, 0.25}}};
  RunRecord run = straight_run(10.0);
  for (PoseSample& pose : run.poses) pose.T_odom_body.translation() += Eigen::Vector3d(0.7, -0.4, 0.0);
  run.hazard_maps = {map_of(25.0, perfect(world, 2.0))};
  // The same in odom, which is off by the same error.
  PassabilityMap in_odom = map_of(25.0, perfect(world, 2.0));
  in_odom.origin_x_m = 2.7;
  in_odom.origin_y_m = -2.4;
  run.traversability_maps = {in_odom};
  const MapFidelities both = fidelities(run, world);
  for (const auto* map : {&both.hazards, &both.traversability}) {
    ASSERT_TRUE(*map);
    EXPECT_EQ(total(**map, 4).ratio(), 1.0);
    EXPECT_EQ(total(**map, 0).impassable, 0);
  }
}

TEST(MapFidelity, TiltedRoverSeesGroundAtItsTruePlace) {
  // 10 deg nose down on flat ground: the map's cells are in the body's plane.
  const BoxWorld world{0.0, {{3.0, 0.5, 0.3, 0.25}}};
  RunRecord run = straight_run(10.0);
  const Eigen::Isometry3d T = make_pose(rotation_from_rpy(0.0, to_rad(10.0), 0.0), {0.0, 0.0, 0.62});
  for (TruthSample& sample : run.truth) sample.T_map_body = T;
  run.hazard_maps = {map_of(5.0, [&](double x, double y) {
    // The point of the block's top or of the ground on the body's z axis through the cell.
    const Eigen::Vector3d p = T * Eigen::Vector3d(x, y, 0.0), up = T.linear().col(2);
    const Eigen::Vector3d top = p + up * ((0.25 - p.z()) / up.z());
    return std::abs(top.x() - 3.0) < 0.35 && std::abs(top.y() - 0.5) < 0.35;
  })};
  const auto map = fidelities(run, world).hazards;
  EXPECT_GT(total(*map, 4).ratio(), 0.9);
  EXPECT_LT(total(*map, 0).ratio(), 0.01);
  EXPECT_EQ(map->rocks, 1);
  EXPECT_EQ(map->rocks_never_closed, 0);
}

TEST(MapFidelity, CountsChangesOfPlacesFixedInTheWorld) {
  const BoxWorld world{0.0, {}};
  RunRecord run = straight_run(10.0);
  for (int i = 0; i < 5; ++i) {
    const double x = 0.4 * i;  // whole cells: the same places in each map
    run.hazard_maps.push_back(map_of(5.0 + 10.0 * x, [&](double bx, double by) {
      const bool flickering = std::abs(x + bx - 3.0) < 0.2 && std::abs(by) < 0.5;
      return flickering && i % 2 == 1;
    }));
  }
  const auto map = fidelities(run, world).hazards;
  // 4 x 10 cells change at each of the four later maps.
  EXPECT_NEAR(map->changes_per_cell * map->observed_cells, 160.0, 1e-6);
  EXPECT_NEAR(map->observed_cells, 1600 + 4 * 4 * 40, 41) << "the union of the maps";
}

TEST(MapFidelity, MapThatTurnsWithTheRoverDoesNotChangeFreeGround) {
  const BoxWorld world{0.0, {}};
  RunRecord run = straight_run(10.0);
  for (TruthSample& sample : run.truth) sample.T_map_body = pose_at(0.0, 0.0, 0.01 * sample.t_s);
  for (double t = 5.0; t < 100.0; t += 1.0) run.hazard_maps.push_back(map_of(t, [](double, double) { return false; }));
  EXPECT_EQ(fidelities(run, world).hazards->changes_per_cell, 0.0);
}

TEST(MapFidelity, FirstClosingIsTheDistanceFromTheCamera) {
  // Closed from 2 m ahead of the body origin on, never, and too low to count.
  const BoxWorld world{0.0, {{6.0, 0.0, 0.2, 0.25}, {6.0, 1.2, 0.2, 0.25}, {6.0, -1.2, 0.2, 0.14}}};
  RunRecord run = straight_run(10.0);
  for (double x = 0.0; x < 5.0; x += 0.05)
    run.hazard_maps.push_back(map_of(5.0 + 10.0 * x, [&](double bx, double by) {
      return x + 2.0 >= 6.0 - 1e-6 && std::abs(x + bx - 6.0) < 0.2 && std::abs(by) < 0.2;
    }));
  const auto map = fidelities(run, world).hazards;
  EXPECT_EQ(map->rocks, 2);
  EXPECT_EQ(map->rocks_never_closed, 1);
  EXPECT_NEAR(map->first_closed_median_m, 2.0 - kLocCamX - 0.2, 0.03);
  EXPECT_NEAR(map->first_closed_p10_m, map->first_closed_median_m, 1e-9);
}

TEST(MapFidelity, RepeatedLooksDoNotNarrowTheInterval) {
  const BoxWorld world{0.0, {{2.0, 0.0, 0.2, 0.25}}};
  RunRecord run = straight_run(10.0);
  const auto closed = [](double x, double y) { return std::abs(x - 2.0) < 0.2 && y > 0.0 && y < 0.2; };
  for (int i = 0; i < 10; ++i) run.hazard_maps.push_back(map_of(4.5 + 0.01 * i, closed));
  run.states[1].t_s = 4.0;  // still stationary
  const FidelityCount count = fidelities(run, world).hazards->counts[4][1];
  EXPECT_EQ(count.looks, 160);
  EXPECT_EQ(count.cells, 16);
  EXPECT_NEAR(count.ratio(), 0.5, 1e-9);
  EXPECT_NEAR(count.interval().low, wilson(8, 16).low, 1e-12);
}

TEST(MapFidelity, RockGlimpsedAtTheEdgeIsNotCountedAsMissed) {
  // Observed once from 3.3 m and never again; then from 2.9 m.
  const BoxWorld world{0.0, {{3.85, 0.0, 0.1, 0.25}}};
  RunRecord run = straight_run(10.0);
  run.hazard_maps = {map_of(5.0, [](double, double) { return false; })};
  EXPECT_EQ(fidelities(run, world).hazards->rocks, 0);
  run.hazard_maps.push_back(map_of(9.0, [](double, double) { return false; }));
  EXPECT_EQ(fidelities(run, world).hazards->rocks_never_closed, 1);
}

TEST(PassabilityMap, OutsideOfTheGridIsUnseen) {
  const PassabilityMap map = map_of(0.0, [](double x, double y) { return x < 0.1 && y < -1.9; });
  EXPECT_EQ(map.at(0.01, -1.99), PassabilityMap::kImpassable);
  EXPECT_EQ(map.at(3.99, 1.99), PassabilityMap::kPassable);
  for (const auto& [x, y] : {std::pair{-0.01, 0.0}, std::pair{4.01, 0.0}, std::pair{1.0, 2.01}, std::pair{1.0, -2.01},
                             std::pair{kNaN, 0.0}, std::pair{1e300, 0.0}})
    EXPECT_EQ(map.at(x, y), PassabilityMap::kUnseen) << x << " " << y;
}

TEST(PassabilityMap, MarginAndUnknownCellsAreUnseen) {
  hazards_t hazards{};
  hazards.cell_m = 0.1;
  hazards.size = hazards.cells_x = 6;
  hazards.cells_y = 1;
  hazards.cells = {hazards_t::UNSEEN, hazards_t::FREE,   hazards_t::OBSTACLE,
                   hazards_t::HOLE,   hazards_t::MARGIN, hazards_t::LOW};
  using P = PassabilityMap;
  EXPECT_EQ(passability_from(hazards)->cells,
            (std::vector{P::kUnseen, P::kPassable, P::kImpassable, P::kImpassable, P::kUnseen, P::kImpassable}));
  traversability_t costs{};
  costs.cell_m = 0.1;
  costs.size = costs.cells_x = 4;
  costs.cells_y = 1;
  costs.cells = {252, 253, 254, 255};
  costs.step_percent.assign(4, 0);
  costs.height_m.assign(4, 0.0F);
  EXPECT_EQ(passability_from(costs)->cells, (std::vector{P::kPassable, P::kImpassable, P::kImpassable, P::kUnseen}));
}

TEST(PassabilityMap, MessageThatContradictsItselfIsIgnored) {
  hazards_t good{};
  good.cell_m = 0.1;
  good.cells_x = good.cells_y = 2;
  good.size = 4;
  good.cells.assign(4, hazards_t::FREE);
  EXPECT_TRUE(passability_from(good));
  const std::vector<std::function<void(hazards_t&)>> damages = {
      [](hazards_t& m) { m.cells_x = 3; },       [](hazards_t& m) { m.cells_x = m.cells_y = -2; },
      [](hazards_t& m) { m.cell_m = 0.0; },      [](hazards_t& m) { m.cell_m = kNaN; },
      [](hazards_t& m) { m.origin_x_m = kNaN; }, [](hazards_t& m) { m.origin_y_m = 1e9; },
      [](hazards_t& m) { m.cell_m = kInfinity; }};
  for (size_t i = 0; i < damages.size(); ++i) {
    hazards_t bad = good;
    damages[i](bad);
    EXPECT_FALSE(passability_from(bad)) << i;
  }
}

TEST(MapFidelity, MapsFarFromTheRoverOrNowhereAreLeftOut) {
  const BoxWorld world{0.0, {}};
  RunRecord run = straight_run(10.0);
  PassabilityMap far = map_of(50.0, [](double, double) { return true; });
  far.origin_x_m = 1e5;
  run.hazard_maps = {far};
  EXPECT_EQ(fidelities(run, world).hazards->observed_cells, 0);
  run.traversability_maps = {map_of(50.0, [](double, double) { return true; })};
  for (PoseSample& pose : run.poses) pose.T_odom_body.translation().x() = 1e200;
  EXPECT_FALSE(fidelities(run, world).traversability);
  for (TruthSample& sample : run.truth) sample.T_map_body.translation().y() = kNaN;
  EXPECT_FALSE(fidelities(run, world).hazards);
}

TEST(MapFidelity, IsEmptyWithoutMapsOrHeights) {
  const BoxWorld world{0.0, {}};
  RunRecord run = straight_run(10.0);
  EXPECT_FALSE(fidelities(run, world).hazards);
  run.hazard_maps = {map_of(300.0, [](double, double) { return false; })};
  EXPECT_FALSE(fidelities(run, world).hazards) << "after the drive";
  run.hazard_maps[0].t_s = 50.0;
  EXPECT_TRUE(fidelities(run, world).hazards);
  EXPECT_FALSE(fidelities(run, world).traversability);
  TrueWorld unknown = world.truth();
  unknown.ground_m = {};
  EXPECT_FALSE(map_fidelities(run, TrueTrack(run.truth), drive_window(run), Footprint{}, unknown).hazards);
}

}  // namespace
}  // namespace rover::report
