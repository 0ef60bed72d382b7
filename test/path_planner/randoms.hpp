// Random numbers that are the same with every standard library: the distributions of <random> are not.
#pragma once

#include <random>

#include "path_planner/geometry.hpp"

namespace rover::planning::testing_support {

inline double uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1.0p-53;
}

inline double gauss(std::mt19937_64& random) {
  const double radius = std::sqrt(-2.0 * std::log(uniform(random, 1e-12, 1.0)));
  return radius * std::cos(uniform(random, 0.0, 2.0 * kPi));
}

inline Pose2 random_pose(std::mt19937_64& random, double reach_m) {
  const double x = uniform(random, -reach_m, reach_m);
  const double y = uniform(random, -reach_m, reach_m);
  return {x, y, uniform(random, -kPi, kPi)};
}

}  // namespace rover::planning::testing_support
