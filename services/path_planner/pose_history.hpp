// Poses of the last seconds, so that a frame is inserted where the rover was at its exposure.
#pragma once

#include <deque>
#include <optional>

#include "common/core/frames.hpp"
#include "common/core/time.hpp"

namespace rover::planning {

struct PoseSample {
  Utime utime = kNever;
  bool usable = false;                           // its status gives a position, and every number is finite
  bool new_odom = false;                         // localization begins anew: odom will be another frame
  Eigen::Isometry3d T_odom_ground = nan_pose();  // see ground_pose
  Eigen::Isometry3d T_map_odom = nan_pose();
  double forward_mps = 0.0;
  double left_mps = 0.0;
  double yaw_rate_radps = 0.0;
  double dead_reckoned_m = 0.0;  // total of what was driven on wheel odometry alone
};

class PoseHistory {
 public:
  void add(const PoseSample& sample);
  void clear() { samples_.clear(); }
  bool empty() const { return samples_.empty(); }
  const PoseSample& newest() const { return samples_.back(); }
  // Interpolated; nothing outside of the samples.
  std::optional<Eigen::Isometry3d> at(Utime utime) const;

 private:
  std::deque<PoseSample> samples_;
};

}  // namespace rover::planning
