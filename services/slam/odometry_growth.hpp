// How far odometry may have erred: POSE's deviations without what the rover was told, and the distance driven without
// visual odometry. Continues over restarts.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <rover/pose_t.hpp>

#include "common/bus/dead_reckoned_distance.hpp"
#include "slam/slam.hpp"

namespace rover::slam {

// A deviation without its sudden changes: those are of a start pose or a correction, not of odometry.
class OdometryDeviation {
 public:
  explicit OdometryDeviation(double sudden) : sudden_(sudden) {}

  double add(double sigma, bool next_tick) {
    if (next_tick && std::abs(sigma - newest_) > sudden_) told_variance_ += sigma * sigma - newest_ * newest_;
    newest_ = sigma;
    return std::sqrt(std::max(0.0, sigma * sigma - told_variance_));
  }
  // `sigma` now is `deviation` of odometry.
  void restart(double sigma, double deviation) { told_variance_ = sigma * sigma - deviation * deviation; }

 private:
  double sudden_;
  double newest_ = kNaN;
  double told_variance_ = 0.0;
};

class OdometryGrowth {
 public:
  explicit OdometryGrowth(double cpu_scale) : dead_reckoned_(cpu_scale) {}

  // `last`: of a checkpoint. What was driven since then may have been without visual odometry.
  void restore(const Odometry& last) { last_ = last; }
  // Call for each POSE; `odometry` is of it.
  void add(const pose_t& pose, Odometry& odometry);

 private:
  DeadReckonedDistance dead_reckoned_;
  OdometryDeviation position_{0.02};  // [m]: wheels alone add 0.3 mm in a tick
  OdometryDeviation yaw_{to_rad(0.1)};
  std::optional<Odometry> last_;  // until the first POSE
  double before_m_ = 0.0;         // dead-reckoned before this process
  Utime utime_ = kNever;
};

}  // namespace rover::slam
