// Random places for the tests of the planner.
#pragma once

#include "path_planner/geometry.hpp"
#include "test/common/randoms.hpp"

namespace rover::planning::testing_support {

using rover::testing_support::uniform;

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
