// An infinite flat field of rocks, reproducible by seed, and rocks placed on the rover's path.
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "common/core/frames.hpp"
#include "test/path_planner/rock_world.hpp"

namespace rover::bench_faults {

using planning::testing_support::Rock;

class Field {
 public:
  explicit Field(std::uint64_t seed) : seed_(seed) {}

  // A row of rocks across the path, with its near side this far ahead.
  void lay_rocks(const Pose2& pose, double ahead_m);
  // A ring of rocks around the rover: it can turn in it, but not leave it.
  void enclose(const Pose2& pose);
  void remove_rocks() { laid_.clear(); }
  // In body axes of the pose, within reach_m.
  std::vector<Rock> around(const Pose2& pose, double reach_m);

 private:
  const std::vector<Rock>& tile(int ix, int iy);

  std::uint64_t seed_;
  std::map<std::pair<int, int>, std::vector<Rock>> tiles_;
  std::vector<Rock> laid_;
};

}  // namespace rover::bench_faults
