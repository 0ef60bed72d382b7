// Disc planes compared with brute force, and the difficulty ahead.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "test/traversability/synthetic_terrain.hpp"
#include "traversability/difficulty.hpp"

namespace rover::trav {
namespace {

using namespace testing_support;

struct BruteForce {
  int n = 0;
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();  // height at the cell's centre, slopes
  double rms_m = 0.0;
};

BruteForce brute_force(const TerrainGrid& grid, const std::vector<std::uint8_t>& mask, int cx, int cy, double radius) {
  std::vector<Eigen::Vector3d> rows;
  std::vector<double> heights;
  for (int iy = 0; iy < grid.shape.cells_y; ++iy)
    for (int ix = 0; ix < grid.shape.cells_x; ++ix) {
      const double dx = (ix - cx) * grid.shape.cell_m, dy = (iy - cy) * grid.shape.cell_m;
      if (std::hypot(dx, dy) > radius + 1e-9 || !mask[grid.shape.at(ix, iy)]) continue;
      rows.emplace_back(1.0, dx, dy);
      heights.push_back(grid.height_m[grid.shape.at(ix, iy)]);
    }
  BruteForce out;
  out.n = static_cast<int>(rows.size());
  Eigen::MatrixXd A(out.n, 3);
  Eigen::VectorXd b(out.n);
  for (int k = 0; k < out.n; ++k) {
    A.row(k) = rows[static_cast<std::size_t>(k)].transpose();
    b[k] = heights[static_cast<std::size_t>(k)];
  }
  out.plane = A.colPivHouseholderQr().solve(b);
  out.rms_m = std::sqrt((A * out.plane - b).squaredNorm() / out.n);
  return out;
}

TEST(DiscPlanesTest, MatchBruteForceLeastSquares) {
  SyntheticMap spec;
  spec.cells = 48;
  spec.noise_m = 0.05;
  const TerrainGrid grid = synthetic_terrain([](double x, double y) { return 250.0 + 0.2 * x * y + 0.3 * y; }, spec, 5);
  std::mt19937_64 random(9);
  std::vector<std::uint8_t> mask(grid.shape.size());
  for (std::uint8_t& c : mask) c = rover::testing_support::uniform(random, 0.0, 1.0) < 0.7;
  DiscPlanes planes(grid.shape, {});
  planes.fit(grid.height_m, mask);
  for (int cy : {0, 3, 20, 47})
    for (int cx : {0, 9, 31, 46}) {
      const std::size_t i = grid.shape.at(cx, cy);
      const BruteForce expected = brute_force(grid, mask, cx, cy, 0.9);
      EXPECT_EQ(planes.count(i), expected.n);
      if (expected.n < 0.2 * 253) {
        EXPECT_TRUE(std::isnan(planes.at(i).slope_x));
        continue;
      }
      EXPECT_NEAR(planes.at(i).height_m, expected.plane[0], 1e-4);
      EXPECT_NEAR(planes.at(i).slope_x, expected.plane[1], 1e-5);
      EXPECT_NEAR(planes.at(i).slope_y, expected.plane[2], 1e-5);
      EXPECT_NEAR(planes.at(i).rms_m, expected.rms_m, 1e-5);
    }
}

TEST(DiscPlanesTest, LineOfCellsHasNoPlane) {
  const TerrainGrid grid = synthetic_terrain([](double, double) { return 0.0; }, {.cells = 40});
  std::vector<std::uint8_t> mask(grid.shape.size(), 0);
  for (int ix = 0; ix < 40; ++ix) mask[grid.shape.at(ix, 20)] = mask[grid.shape.at(ix, 21)] = 1;
  DiscPlanes planes(grid.shape, {.min_seen_fraction = 0.05});
  planes.fit(grid.height_m, mask);
  EXPECT_GT(planes.count(grid.shape.at(20, 20)), 30);
  EXPECT_TRUE(std::isnan(planes.at(grid.shape.at(20, 20)).slope_x));
}

class DifficultyTest : public testing::Test {
 protected:
  // Flat, with cylinders of 0.3 m where x > 0.
  static TraversabilityMap half_rocky() {
    return compute_traversability(synthetic_terrain([](double x, double y) {
                                    const double dx = x - std::round(x), dy = y - std::round(y);
                                    return x > 0.0 ? block_m(dx, dy, 0.3, 0.2) : 0.0;
                                  }),
                                  {});
  }
};

TEST_F(DifficultyTest, UsesGroundAheadNotBehind) {
  const TraversabilityMap map = half_rocky();
  EXPECT_GT(difficulty_ahead(map, {0.0, 0.0, 0.0}, {}), 0.9);
  EXPECT_LT(difficulty_ahead(map, {-1.0, 0.0, kPi}, {}), 0.05);
  EXPECT_LT(difficulty_ahead(map, {-4.0, 0.0, 0.5 * kPi}, {}), 0.05);
  EXPECT_GT(difficulty_ahead(map, {4.0, 0.0, -0.5 * kPi}, {}), 0.9);
}

TEST_F(DifficultyTest, GrowsWithSlope) {
  double last = -0.01;
  for (double slope : {0.0, 0.05, 0.1, 0.2, 0.3, 0.5}) {
    const double now =
        difficulty_ahead(compute_traversability(synthetic_terrain([&](double x, double) { return slope * x; }), {}),
                         {0.0, 0.0, 1.0}, {});
    EXPECT_GT(now, last) << slope;
    last = now;
  }
  EXPECT_NEAR(last, 1.0, 1e-9);
}

TEST_F(DifficultyTest, IsNanWhenTooLittleIsKnown) {
  const TraversabilityMap map = half_rocky();
  EXPECT_TRUE(std::isnan(difficulty_ahead(map, {9.0, 0.0, 0.0}, {})));
  EXPECT_TRUE(std::isnan(difficulty_ahead(map, {500.0, 0.0, 0.0}, {})));
  EXPECT_TRUE(std::isnan(difficulty_ahead(map, {kNaN, 0.0, 0.0}, {})));
}

}  // namespace
}  // namespace rover::trav
