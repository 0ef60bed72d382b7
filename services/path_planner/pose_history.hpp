// Poses of the last seconds, so that a frame is laid where the rover was at its exposure; and how much the rover's
// position has become uncertain over the last metres.
#pragma once

#include <deque>
#include <optional>

#include "common/core/frames.hpp"
#include "common/core/time.hpp"

namespace rover::planning {

struct PoseSample {
  Utime utime = kNever;
  bool usable = false;  // status tells of a position, and every number is finite
  Eigen::Isometry3d T_odom_body = nan_pose();
  Eigen::Isometry3d T_map_odom = nan_pose();
  double position_variance_m2 = kNaN;  // the larger of x and y
  double forward_mps = 0.0;
  double yaw_rate_radps = 0.0;
  double travelled_m = 0.0;
};

class PoseHistory {
 public:
  void add(const PoseSample& sample);
  void clear();
  bool empty() const { return samples_.empty(); }
  const PoseSample& newest() const { return samples_.back(); }
  // Interpolated; nothing outside of what is remembered.
  std::optional<Eigen::Isometry3d> at(Utime utime) const;
  // Standard deviation that the position has gained over the way for which hazards are remembered ahead of the rover.
  double gained_sigma_m() const;

 private:
  struct Station {
    double travelled_m;
    double variance_m2;
  };
  std::deque<PoseSample> samples_;
  std::deque<Station> stations_;
};

}  // namespace rover::planning
