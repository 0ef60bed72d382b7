// Compares fast marching with exact distances, its difference equation, and Dijkstra.
#include "common/core/fast_marching.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <queue>

#include "common/core/frames.hpp"
#include "test/common/randoms.hpp"

namespace rover {
namespace {

using testing_support::uniform;

constexpr double kFarBeyond = kInfinity;

MarchGrid even_ground(int side, double cell_m) {
  return {side, side, cell_m, std::vector<double>(static_cast<size_t>(side) * side, 1.0)};
}

int cell_at(const MarchGrid& grid, int x, int y) {
  return y * grid.width + x;
}

std::vector<double> march_all(const MarchGrid& grid, int from) {
  return march(grid, {{from, 0.0}}, -1, kFarBeyond);
}

// Bumps of up to three times the cost, some cells impassable.
MarchGrid random_ground(int side, double blocked, std::mt19937_64& random) {
  MarchGrid grid = even_ground(side, 0.1);
  for (int bump = 0; bump < 12; ++bump) {
    const double bx = uniform(random, 0.0, side);
    const double by = uniform(random, 0.0, side);
    const double width = uniform(random, 5.0, 12.0);
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x)
        grid.cost_per_m[cell_at(grid, x, y)] += 2.0 * std::exp(-std::pow(std::hypot(x - bx, y - by) / width, 2));
  }
  for (double& cost : grid.cost_per_m)
    if (uniform(random, 0.0, 1.0) < blocked) cost = kInfinity;
  return grid;
}

// Cells of the same ground, `parts` to a side.
MarchGrid refined(const MarchGrid& grid, int parts) {
  MarchGrid fine = even_ground(grid.width * parts, grid.cell_m / parts);
  for (int y = 0; y < fine.height; ++y)
    for (int x = 0; x < fine.width; ++x)
      fine.cost_per_m[cell_at(fine, x, y)] = grid.cost_per_m[cell_at(grid, x / parts, y / parts)];
  return fine;
}

// Steps to all cells within `reach` that are not multiples of shorter steps; the cost is that of the crossed cells.
std::vector<double> dijkstra(const MarchGrid& grid, int from, int reach) {
  std::vector<double> best(grid.cost_per_m.size(), kInfinity);
  std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>, std::greater<>> open;
  best[from] = 0.0;
  open.emplace(0.0, from);
  const auto cost_of_step = [&](int x, int y, int dx, int dy) {
    const int samples = 4 * reach;
    double sum = 0.0;
    for (int i = 0; i < samples; ++i) {
      const double u = (i + 0.5) / samples;
      const int sx = static_cast<int>(std::floor(x + 0.5 + u * dx));
      const int sy = static_cast<int>(std::floor(y + 0.5 + u * dy));
      sum += grid.cost_per_m[cell_at(grid, sx, sy)];
    }
    return grid.cell_m * std::hypot(dx, dy) * sum / samples;
  };
  while (!open.empty()) {
    const auto [cost, cell] = open.top();
    open.pop();
    if (cost > best[cell]) continue;
    const int x = cell % grid.width;
    const int y = cell / grid.width;
    for (int dy = -reach; dy <= reach; ++dy)
      for (int dx = -reach; dx <= reach; ++dx) {
        if (std::gcd(dx, dy) != 1) continue;
        if (x + dx < 0 || y + dy < 0 || x + dx >= grid.width || y + dy >= grid.height) continue;
        const int next = cell_at(grid, x + dx, y + dy);
        const double sum = cost + cost_of_step(x, y, dx, dy);
        if (sum >= best[next]) continue;
        best[next] = sum;
        open.emplace(sum, next);
      }
  }
  return best;
}

double worst_error_m(double cell_m) {
  const int half = static_cast<int>(std::lround(5.0 / cell_m));
  const MarchGrid grid = even_ground(2 * half + 1, cell_m);
  const std::vector<double> travel = march_all(grid, cell_at(grid, half, half));
  double worst = 0.0;
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x) {
      const double exact = cell_m * std::hypot(x - half, y - half);
      EXPECT_GE(travel[cell_at(grid, x, y)], exact - 1e-9);
      worst = std::max(worst, travel[cell_at(grid, x, y)] - exact);
    }
  return worst;
}

TEST(FastMarching, OnEvenGroundTheCostIsTheDistance) {
  // First-order error on diagonals: below 1.5 cells on a map of 10 m, and less with smaller cells.
  const double coarse = worst_error_m(0.1);
  const double fine = worst_error_m(0.05);
  EXPECT_LT(coarse, 0.15);
  EXPECT_LT(fine, 0.7 * coarse);
}

TEST(FastMarching, AlongAxesTheDistanceIsExact) {
  const MarchGrid grid = even_ground(41, 0.1);
  const std::vector<double> travel = march_all(grid, cell_at(grid, 5, 7));
  for (int x = 0; x < 41; ++x) EXPECT_NEAR(travel[cell_at(grid, x, 7)], 0.1 * std::abs(x - 5), 1e-9);
}

TEST(FastMarching, BehindAWallTheWayLeadsRoundItsEnd) {
  MarchGrid grid = even_ground(101, 0.1);
  for (int y = 0; y <= 60; ++y) grid.cost_per_m[cell_at(grid, 50, y)] = kInfinity;
  const std::vector<double> travel = march_all(grid, cell_at(grid, 30, 20));
  // The shortest path touches the last blocked cell's upper corners, half a cell beside and above its centre.
  for (const auto& [x, y] : {std::pair{70, 20}, std::pair{60, 5}, std::pair{90, 40}}) {
    const double exact = 0.1 * (std::hypot(49.5 - 30.0, 60.5 - 20.0) + 1.0 + std::hypot(x - 50.5, y - 60.5));
    EXPECT_NEAR(travel[cell_at(grid, x, y)], exact, 0.04 * exact) << x << " " << y;
    EXPECT_GT(travel[cell_at(grid, x, y)], exact - 0.01);
  }
  for (int y = 0; y <= 60; ++y) EXPECT_EQ(travel[cell_at(grid, 50, y)], kInfinity);
}

TEST(FastMarching, WhatCannotBeReachedIsInfinite) {
  MarchGrid grid = even_ground(30, 0.1);
  for (int i = 10; i <= 20; ++i)
    for (const int edge : {10, 20}) {
      grid.cost_per_m[cell_at(grid, i, edge)] = kInfinity;
      grid.cost_per_m[cell_at(grid, edge, i)] = kInfinity;
    }
  const std::vector<double> outside = march_all(grid, cell_at(grid, 0, 0));
  EXPECT_EQ(outside[cell_at(grid, 15, 15)], kInfinity);
  EXPECT_TRUE(std::isfinite(outside[cell_at(grid, 29, 29)]));
  const std::vector<double> inside = march_all(grid, cell_at(grid, 15, 15));
  EXPECT_EQ(inside[cell_at(grid, 0, 0)], kInfinity);
  EXPECT_TRUE(std::isfinite(inside[cell_at(grid, 19, 19)]));
}

TEST(FastMarching, ASeedOnImpassableGroundAndNoSeedMarchNowhere) {
  MarchGrid grid = even_ground(5, 0.1);
  grid.cost_per_m[12] = kInfinity;
  for (const double t : march(grid, {{12, 0.0}}, -1, kFarBeyond)) EXPECT_EQ(t, kInfinity);
  for (const double t : march(grid, {}, -1, kFarBeyond)) EXPECT_EQ(t, kInfinity);
}

double min_neighbour(const MarchGrid& grid, const std::vector<double>& travel, int x, int y, int dx, int dy) {
  const auto at = [&](int nx, int ny) {
    const bool inside = nx >= 0 && ny >= 0 && nx < grid.width && ny < grid.height;
    return inside ? travel[cell_at(grid, nx, ny)] : kInfinity;
  };
  return std::min(at(x - dx, y - dy), at(x + dx, y + dy));
}

TEST(FastMarching, EveryCellSolvesTheUpwindEquation) {
  std::mt19937_64 random(4);
  for (int field = 0; field < 20; ++field) {
    const MarchGrid grid = random_ground(60, 0.1, random);
    const int seed = cell_at(grid, 30, 30);
    const std::vector<double> travel = march_all(grid, seed);
    for (int i = 0; i < 3600; ++i) {
      if (i == seed || std::isinf(travel[i])) continue;
      const double a = std::max(0.0, travel[i] - min_neighbour(grid, travel, i % 60, i / 60, 1, 0));
      const double b = std::max(0.0, travel[i] - min_neighbour(grid, travel, i % 60, i / 60, 0, 1));
      ASSERT_NEAR(std::hypot(a, b), grid.cell_m * grid.cost_per_m[i], 1e-9) << field << " cell " << i;
    }
  }
}

TEST(FastMarching, MoreCostNeverMakesAWayCheaperAndScalesIt) {
  std::mt19937_64 random(5);
  const MarchGrid grid = random_ground(50, 0.05, random);
  MarchGrid costlier = grid;
  MarchGrid twice = grid;
  for (double& cost : costlier.cost_per_m) cost += uniform(random, 0.0, 1.0);
  for (double& cost : twice.cost_per_m) cost *= 2.0;
  const std::vector<double> travel = march_all(grid, 0);
  const std::vector<double> costs = march_all(costlier, 0);
  const std::vector<double> doubled = march_all(twice, 0);
  for (size_t i = 0; i < travel.size(); ++i) {
    EXPECT_GE(costs[i], travel[i]);
    EXPECT_EQ(doubled[i], 2.0 * travel[i]);
  }
}

TEST(FastMarching, LiesBetweenDijkstraByCellsAndDijkstraOnAFineGrid) {
  std::mt19937_64 random(6);
  for (int field = 0; field < 3; ++field) {
    const MarchGrid grid = random_ground(40, 0.0, random);
    const std::vector<double> travel = march_all(grid, cell_at(grid, 8, 8));
    // With 4-neighbour steps no path is shorter than the front's.
    const std::vector<double> by_cells = [&] {
      std::vector<double> best(travel.size(), kInfinity);
      best[cell_at(grid, 8, 8)] = 0.0;
      for (int round = 0; round < 80; ++round)  // Bellman and Ford: enough for 80 steps
        for (int i = 0; i < 1600; ++i)
          best[i] =
              std::min(best[i], 0.1 * grid.cost_per_m[i] + std::min(min_neighbour(grid, best, i % 40, i / 40, 1, 0),
                                                                    min_neighbour(grid, best, i % 40, i / 40, 0, 1)));
      return best;
    }();
    const MarchGrid fine = refined(grid, 3);
    const std::vector<double> exact = dijkstra(fine, cell_at(fine, 25, 25), 3);
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 40; ++x) {
        const double t = travel[cell_at(grid, x, y)];
        ASSERT_LE(t, by_cells[cell_at(grid, x, y)] + 1e-9);
        if (std::hypot(x - 8, y - 8) < 10.0) continue;
        const double best = exact[cell_at(fine, 3 * x + 1, 3 * y + 1)];
        ASSERT_NEAR(t, best, 0.06 * best + 0.1) << field << " at " << x << " " << y;
      }
  }
}

TEST(FastMarching, SeveralSeedsGiveTheCheapest) {
  const MarchGrid grid = even_ground(81, 0.1);
  const std::vector<double> a = march(grid, {{cell_at(grid, 10, 40), 0.0}}, -1, kFarBeyond);
  const std::vector<double> b = march(grid, {{cell_at(grid, 70, 40), 2.0}}, -1, kFarBeyond);
  const std::vector<double> both =
      march(grid, {{cell_at(grid, 10, 40), 0.0}, {cell_at(grid, 70, 40), 2.0}}, -1, kFarBeyond);
  for (size_t i = 0; i < both.size(); ++i) {
    EXPECT_LE(both[i], std::min(a[i], b[i]) + 1e-9);
    EXPECT_GE(both[i], std::min(a[i], b[i]) - 0.1);  // less only where both fronts meet
  }
}

TEST(FastMarching, StopsBeyondTheTargetWithTheSameCosts) {
  std::mt19937_64 random(7);
  const MarchGrid grid = random_ground(60, 0.05, random);
  const int target = cell_at(grid, 20, 20);
  const std::vector<double> all = march_all(grid, 0);
  const std::vector<double> some = march(grid, {{0, 0.0}}, target, 0.5);
  int left_out = 0;
  for (size_t i = 0; i < all.size(); ++i) {
    EXPECT_TRUE(some[i] == all[i] || all[i] > all[target] + 0.5) << i;
    EXPECT_TRUE(some[i] == all[i] || std::isinf(some[i])) << i;
    if (std::isfinite(all[i]) && std::isinf(some[i])) ++left_out;
  }
  EXPECT_GT(left_out, 1000);
}

}  // namespace
}  // namespace rover
