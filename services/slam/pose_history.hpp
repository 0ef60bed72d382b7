// Recent POSE samples, to look up the pose at a cloud's exposure.
#pragma once

#include <deque>
#include <optional>

#include "slam/slam.hpp"

namespace rover::slam {

struct PoseSample {
  Utime utime = kNever;
  Odometry odometry;
  Eigen::Isometry3d T_map_odom = nan_pose();
};

class PoseHistory {
 public:
  // Ignores samples that are not newer than the newest.
  void add(const PoseSample& sample);
  // Interpolated; empty outside the stored time span and within a gap.
  std::optional<Odometry> at(Utime utime) const;

 private:
  std::deque<PoseSample> samples_;
};

}  // namespace rover::slam
