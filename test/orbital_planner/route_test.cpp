// Paths on cost maps with known optimum.
#include "tools/orbital_planner/route.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/core/frames.hpp"
#include "test/common/randoms.hpp"

namespace rover::orbital {
namespace {

using Eigen::Vector2d;
using testing_support::uniform;

MarchGrid even_grid(int width, int height) {
  return {width, height, 1.0, std::vector<double>(static_cast<size_t>(width) * height, 1.0)};
}

double& cost(MarchGrid& grid, int x, int y) {
  return grid.cost_per_m[static_cast<size_t>(y) * grid.width + x];
}

double cost_of(const MarchGrid& grid, const Line& line) {
  const Line fine = resampled(line, 0.1, even_grid(grid.width, grid.height));
  double sum = 0.0;
  for (size_t i = 1; i < fine.size(); ++i)
    sum += (fine[i] - fine[i - 1]).norm() * cost_at(grid, 0.5 * (fine[i] + fine[i - 1]));
  return sum;
}

void expect_open(const MarchGrid& grid, const Line& line) {
  for (size_t i = 1; i < line.size(); ++i) EXPECT_TRUE(is_open(grid, line[i - 1], line[i])) << i;
}

TEST(MinimumCostPath, IsNearlyStraightOnUniformCost) {
  const MarchGrid grid = even_grid(100, 80);
  for (const auto& [a, b] :
       {std::pair{Vector2d(3.2, 4.1), Vector2d(95.7, 70.3)}, std::pair{Vector2d(90.5, 10.5), Vector2d(90.5, 70.5)},
        std::pair{Vector2d(80.0, 5.0), Vector2d(10.0, 75.0)}}) {
    const std::optional<Line> line = minimum_cost_path(grid, a, b);
    ASSERT_TRUE(line);
    EXPECT_EQ(line->front(), a);
    EXPECT_EQ(line->back(), b);
    EXPECT_LT(length_m(*line), 1.02 * (b - a).norm());
    EXPECT_GE(length_m(*line), (b - a).norm() - 1e-9);
  }
}

TEST(MinimumCostPath, TouchesEndOfWall) {
  MarchGrid grid = even_grid(100, 100);
  for (int y = 0; y <= 60; ++y) cost(grid, 50, y) = kInfinity;
  const Vector2d a(30.5, 20.5), b(75.5, 25.5);
  const std::optional<Line> line = minimum_cost_path(grid, a, b);
  ASSERT_TRUE(line);
  expect_open(grid, *line);
  const double shortest = (Vector2d(50, 61) - a).norm() + 1.0 + (b - Vector2d(51, 61)).norm();
  EXPECT_LT(length_m(*line), 1.03 * shortest);
  EXPECT_GT(length_m(*line), shortest - 0.1);
}

TEST(MinimumCostPath, CrossesCostlyStripOnlyIfCheaperThanDetour) {
  for (const auto& [cost_factor, crosses] : {std::pair{1.5, true}, std::pair{30.0, false}}) {
    MarchGrid grid = even_grid(80, 60);
    for (int y = 0; y < 50; ++y)
      for (int x = 38; x < 42; ++x) cost(grid, x, y) = cost_factor;
    const std::optional<Line> line = minimum_cost_path(grid, {20.5, 20.5}, {60.5, 20.5});
    ASSERT_TRUE(line);
    const bool crossed =
        std::any_of(line->begin(), line->end(), [&](const Vector2d& p) { return cost_at(grid, p) > 1.2; });
    EXPECT_EQ(crossed, crosses) << cost_factor;
  }
}

// Brute force: no straight path, and none with one corner on a lattice, is cheaper beyond the discretisation error.
TEST(MinimumCostPath, NoSampledPathIsCheaper) {
  std::mt19937_64 random(5);
  for (int trial = 0; trial < 5; ++trial) {
    MarchGrid grid = even_grid(60, 60);
    for (int bump = 0; bump < 8; ++bump) {
      const double bx = uniform(random, 5, 55), by = uniform(random, 5, 55), high = uniform(random, 2, 8);
      for (int y = 0; y < 60; ++y)
        for (int x = 0; x < 60; ++x)
          cost(grid, x, y) += high * std::exp(-0.02 * ((x - bx) * (x - bx) + (y - by) * (y - by)));
    }
    const Vector2d a(4.5, 6.5), b(54.5, 52.5);
    const std::optional<Line> line = minimum_cost_path(grid, a, b);
    ASSERT_TRUE(line);
    const double own = cost_of(grid, *line);
    EXPECT_LT(own, 1.03 * cost_of(grid, {a, b}));
    for (int y = 2; y < 60; y += 4)
      for (int x = 2; x < 60; x += 4) EXPECT_LT(own, 1.03 * cost_of(grid, {a, {x + 0.5, y + 0.5}, b}));
  }
}

TEST(MinimumCostPath, BetweenScatteredObstaclesItNeverEntersOne) {
  std::mt19937_64 random(11);
  int found = 0;
  for (int trial = 0; trial < 40; ++trial) {
    MarchGrid grid = even_grid(50, 50);
    for (double& c : grid.cost_per_m) c = uniform(random, 0, 1) < 0.3 ? kInfinity : uniform(random, 1.0, 4.0);
    cost(grid, 2, 2) = cost(grid, 47, 46) = 1.0;
    const std::optional<Line> line = minimum_cost_path(grid, {2.3, 2.8}, {47.9, 46.1});
    if (!line) continue;
    ++found;
    expect_open(grid, *line);
    expect_open(grid, resampled(*line, 1.5, grid));
    expect_open(grid, smoothed(resampled(*line, 1.5, grid), grid, {}));
  }
  EXPECT_GT(found, 20);
}

TEST(MinimumCostPath, NoPathThroughClosedWall) {
  MarchGrid grid = even_grid(40, 40);
  for (int y = 0; y < 40; ++y) cost(grid, 20, y) = kInfinity;
  EXPECT_FALSE(minimum_cost_path(grid, {5.5, 5.5}, {30.5, 30.5}));
}

TEST(MinimumCostPath, WithinOneCellItIsStraight) {
  const std::optional<Line> line = minimum_cost_path(even_grid(10, 10), {5.1, 5.1}, {5.8, 5.6});
  ASSERT_TRUE(line);
  EXPECT_NEAR(length_m(*line), std::hypot(0.7, 0.5), 1e-9);
}

TEST(Resampled, PointsLieEvenlyOnTheLine) {
  const Line line{{0, 0}, {3, 0}, {3, 0.5}, {3, 10}, {7, 10}};
  const Line points = resampled(line, 1.5, even_grid(20, 20));
  EXPECT_EQ(points.size(), 12u);  // 17 m in 11 parts
  EXPECT_EQ(points.front(), line.front());
  EXPECT_EQ(points.back(), line.back());
  double passed = 0.0;
  for (size_t i = 1; i < points.size(); ++i) {
    const double step = (points[i] - points[i - 1]).norm();
    EXPECT_LE(step, 17.0 / 11 + 1e-9);
    EXPECT_TRUE(points[i].y() == 0.0 || points[i].x() == 3.0 || points[i].y() == 10.0);
    passed += step;
  }
  EXPECT_GT(passed, 16.0);
}

TEST(Rounded, CornerBecomesDrivableBend) {
  const MarchGrid grid = even_grid(60, 60);
  const Line line = smoothed(resampled({{5.5, 5.5}, {45.5, 5.5}, {45.5, 45.5}}, 1.5, grid), grid, {});
  EXPECT_EQ(line.front(), Vector2d(5.5, 5.5));
  EXPECT_EQ(line.back(), Vector2d(45.5, 45.5));
  double nearest = kInfinity;
  for (size_t i = 1; i + 1 < line.size(); ++i) {
    const Vector2d a = line[i] - line[i - 1], b = line[i + 1] - line[i];
    const double turn = std::abs(std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)));
    EXPECT_LT(turn / (0.5 * (a.norm() + b.norm())), 1.0 / 3.0) << i;
    nearest = std::min(nearest, (line[i] - Vector2d(45.5, 5.5)).norm());
  }
  EXPECT_LT(nearest, 3.0);
}

}  // namespace
}  // namespace rover::orbital
