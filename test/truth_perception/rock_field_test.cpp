// Both maps in a rock field on level ground, where the height of the surface is the height over the ground.
#include <gtest/gtest.h>

#include "common/core/frames.hpp"
#include "test/rover_simulator/world_fixture.hpp"
#include "test/stereo/synthetic_world.hpp"
#include "test/truth_perception/scene.hpp"
#include "tools/truth_perception/true_hazards.hpp"
#include "tools/truth_perception/true_terrain.hpp"
#include "traversability/traversability.hpp"

namespace rover::truth {
namespace {

constexpr double kSideM = 60.0;
constexpr double kToleranceM = 0.02;  // of the ground that both maps estimate between rocks

World field(double rock_area, double roughness_m) {
  WorldConfig config = bare_config();
  config.rocks.k = rock_area;
  config.roughness.rms_m = roughness_m;
  return World(config, level_raster(kSideM), 3);
}

// Counts that both tests compare with the true heights of the cells.
struct Agreement {
  int high = 0, missed = 0, marked = 0, wrong = 0;

  // `top_m`: of the cell; `around_m`: of it and its neighbours.
  void add(bool marked_here, double top_m, double around_m) {
    high += top_m >= 0.15 + kToleranceM;
    missed += !marked_here && top_m >= 0.15 + kToleranceM;
    marked += marked_here;
    wrong += marked_here && around_m < 0.15 - kToleranceM;
  }
  void expect_good(int max_wrong) const {
    EXPECT_GT(high, 80);
    EXPECT_EQ(missed, 0) << "of " << high;
    EXPECT_LE(wrong, max_wrong) << "of " << marked;
  }
};

// The body at (x, 30), heading east.
hazard::HazardResult look(TrueHazards& hazards, double x_m) {
  return hazards.step(make_pose(Eigen::Matrix3d::Identity(), {x_m, 30.0, 0.62}));
}

TEST(TrueMapsInRockField, HazardsAreTheVisibleCellsAboveTheLimit) {
  const World world = field(0.05, 0.0);
  const auto surface = std::make_shared<TrueSurface>(world);
  TrueHazards hazards({}, synthetic::loccam_camera(), surface);
  const hazard::GridShape& shape = hazards.shape();
  Agreement agreement;
  for (double x = 5.0; x < 50.0; x += 0.7) {
    const hazard::HazardResult result = look(hazards, x);
    for (int iy = 0; iy < shape.cells_y; ++iy)
      for (int ix = 0; ix < shape.cells_x; ++ix) {
        const hazard::Cell cell = result.cells[static_cast<size_t>(shape.at(ix, iy))];
        const bool at_edge_of_view = std::abs(shape.y_m(iy)) > 0.35 * shape.x_m(ix);
        if (cell == hazard::Cell::kUnseen || cell == hazard::Cell::kMargin || at_edge_of_view) continue;
        const double west = x + shape.x_m(ix) - 0.5 * kCellM, south = 30.0 + shape.y_m(iy) - 0.5 * kCellM;
        agreement.add(hazard::is_hazard(cell), surface->top_m(west, south, kCellM),
                      surface->top_m(west - kCellM, south - kCellM, 3.0 * kCellM));
      }
  }
  agreement.expect_good(0);
}

trav::TraversabilityMap drive(const std::shared_ptr<TrueSurface>& surface, double to_x_m) {
  TrueTerrain terrain(200, kCellM, surface);
  double x = to_x_m - 5.0;
  for (; x < to_x_m; x += 0.5) terrain.add(navcam_at(x, 30.0, surface->height_m(x, 30.0)));
  trav::TraversabilityConfig config;
  config.step.mean_height_ratio = 1.0;
  const Pose2 body{x, 30.0, 0.0};
  return trav::compute_traversability(terrain.grid({200, 200, kCellM, std::floor(x) - 10.0, 20.0}, body, body), config);
}

TEST(TrueMapsInRockField, ImpassableCellsAreThoseAboveTheLimitAndTheirNeighbours) {
  const World world = field(0.05, 0.0);
  const auto surface = std::make_shared<TrueSurface>(world);
  Agreement agreement;
  for (const double x : {15.0, 25.0, 35.0, 45.0}) {
    const trav::TraversabilityMap map = drive(surface, x);
    for (int iy = 0; iy < 200; ++iy)
      for (int ix = 0; ix < 200; ++ix) {
        const std::uint8_t cost = map.cells[map.shape.at(ix, iy)];
        if (cost == trav::kUnknown) continue;
        const double west = map.shape.x_m(ix) - 0.5 * kCellM, south = map.shape.y_m(iy) - 0.5 * kCellM;
        // Growth over the sides of a rock: two cells.
        agreement.add(cost == trav::kLow || cost == trav::kImpassable, surface->top_m(west, south, kCellM),
                      surface->top_m(west - 2.0 * kCellM, south - 2.0 * kCellM, 5.0 * kCellM));
      }
  }
  agreement.expect_good(agreement.marked / 50);  // growth from rock to rock
}

TEST(TrueMapsInRockField, RoughGroundWithoutRocksIsClear) {
  const World world = field(0.0, 0.012);
  const auto surface = std::make_shared<TrueSurface>(world);
  TrueHazards hazards({}, synthetic::loccam_camera(), surface);
  for (double x = 5.0; x < 50.0; x += 1.5) EXPECT_EQ(look(hazards, x).status, hazard::Status::kClear) << x;
  const trav::TraversabilityMap map = drive(surface, 30.0);
  EXPECT_EQ(std::count(map.cells.begin(), map.cells.end(), trav::kImpassable), 0);
  EXPECT_GT(std::count_if(map.cells.begin(), map.cells.end(), [](int cost) { return cost < trav::kLow; }), 5000);
}

}  // namespace
}  // namespace rover::truth
