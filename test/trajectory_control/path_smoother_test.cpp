#include "trajectory_control/path_smoother.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "test/trajectory_control/drive_loop.hpp"

namespace rover::control {
namespace {

using Points = std::vector<Eigen::Vector2d>;
constexpr double kStep = 0.05;

double largest_distance(const Points& a, const Points& b) {
  double largest = 0.0;
  for (size_t i = 0; i < a.size(); ++i) largest = std::max(largest, (a[i] - b[i]).norm());
  return largest;
}

// Sum of squared third differences (change of curvature).
double roughness(const Points& p) {
  double sum = 0.0;
  for (size_t i = 0; i + 3 < p.size(); ++i)
    sum += (p[i + 3] - 3.0 * p[i + 2] + 3.0 * p[i + 1] - p[i]).squaredNorm() / std::pow(kStep, 6);
  return sum;
}

TEST(Smoother, KeepsLinesAndWideArcs) {
  const Points line = test::polyline({{0.0, 20.0}}, kStep);
  EXPECT_LT(largest_distance(smooth(line, kStep, {}), line), 1e-4);
  const Points arc = test::polyline({{0.1, 20.0}}, kStep);
  EXPECT_LT(largest_distance(smooth(arc, kStep, {}), arc), 5e-3);
}

TEST(Smoother, StaysWithinMaxDistanceAndReducesRoughness) {
  const Points path = test::polyline(test::seed_traverse(), kStep);
  for (const double max_distance_m : {0.03, 0.05, 0.1}) {
    const Points curve = smooth(path, kStep, {.length_m = 1.0, .max_distance_m = max_distance_m});
    EXPECT_LT(largest_distance(curve, path), 1.1 * max_distance_m);
    EXPECT_LT(roughness(curve), 0.2 * roughness(path));
    EXPECT_EQ(curve.front(), path.front());
    EXPECT_EQ(curve.back(), path.back());
  }
}

TEST(Smoother, RemovesStaircaseOfAGridPath) {
  Points stairs;
  for (int i = 0; i < 200; ++i) {
    const double x = i * kStep * 0.9;
    stairs.emplace_back(x, 0.1 * std::floor(x * 0.4 / 0.1));
  }
  const Points curve = smooth(stairs, kStep, {.length_m = 1.0, .max_distance_m = 0.08});
  for (size_t i = 40; i + 40 < curve.size(); ++i) {
    const Eigen::Vector2d d = curve[i + 1] - curve[i - 1];
    EXPECT_NEAR(std::atan2(d.y(), d.x()), std::atan(0.4), 0.12) << i;
  }
}

TEST(Smoother, ShortPathsAndZeroDistanceAreUnchanged) {
  const Points four = {{0, 0}, {1, 0}, {1, 1}, {2, 1}};
  EXPECT_EQ(smooth(four, 1.0, {}), four);
  const Points path = test::polyline({{0.8, 1.0}, {-0.8, 1.0}}, kStep);
  EXPECT_EQ(smooth(path, kStep, {.max_distance_m = 0.0}), path);
}

}  // namespace
}  // namespace rover::control
