// Distance driven on wheel odometry alone, from the age of the visual odometry in POSE.
#pragma once

#include <rover/pose_t.hpp>

#include "common/core/frames.hpp"
#include "common/core/time.hpp"

namespace rover {

class DeadReckonedDistance {
 public:
  explicit DeadReckonedDistance(double cpu_scale = 1.0) : max_vo_age_(to_utime(kMaxVoAgeS * cpu_scale)) {}

  // Returns the total [m], this POSE included.
  double add(const pose_t& pose) {
    const double step_m = pose.travelled_m - travelled_m_;  // NaN for the first POSE
    travelled_m_ = pose.travelled_m;
    const bool stale_vo = pose.last_vo_utime < 0 || pose.header.utime - pose.last_vo_utime > max_vo_age_;
    if (stale_vo && step_m > 0.0) distance_m_ += step_m;
    return distance_m_;
  }

 private:
  static constexpr double kMaxVoAgeS = 0.8;  // frame period 0.4 s and latency 0.3 s; older: a frame is missing

  Utime max_vo_age_;
  double distance_m_ = 0.0;
  double travelled_m_ = kNaN;
};

}  // namespace rover
