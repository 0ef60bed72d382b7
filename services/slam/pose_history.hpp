// POSE of the last seconds, for where the rover was when a cloud was exposed.
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
  // Samples that are not newer than the newest are left out.
  void add(const PoseSample& sample);
  // Interpolated; nothing outside of what is remembered.
  std::optional<Odometry> at(Utime utime) const;

 private:
  std::deque<PoseSample> samples_;
};

}  // namespace rover::slam
