// T_map_slam: how the frame in which SLAM works lies in map.
//
// Localization moves map against odom for two reasons. SLAM's own measurements it takes up slowly; of that nothing
// comes back here. A correction from elsewhere moves it at once: then SLAM says from there on what POSE says, and
// measures only what odometry drifts after it. So SLAM never pulls a correction back.
#pragma once

#include <optional>

#include "common/core/frames.hpp"
#include "common/core/time.hpp"

namespace rover::slam {

struct AnchorConfig {
  double slow_mps = 0.03;  // localization follows SLAM at 0.02 m/s and 0.3 deg/s at most
  double slow_radps = to_rad(0.45);
  double slack_m = 0.0005;
  double slack_rad = 1e-5;
};

class MapAnchor {
 public:
  explicit MapAnchor(const AnchorConfig& config) : config_(config) {}

  // Each POSE. True where map was moved against odom by something else than SLAM.
  bool take(Utime utime, const Eigen::Isometry3d& T_map_odom, const Eigen::Isometry3d& T_odom_body);
  // SLAM agrees with the newest POSE where odometry's drift so far is `T_slam_odom`.
  void anchor(const Pose2& T_slam_odom);
  bool anchored() const { return T_map_slam_.has_value(); }
  // Anchored only.
  Pose2 T_map_odom(const Pose2& T_slam_odom) const;
  Pose2 T_map_slam() const { return *T_map_slam_; }
  void restore(const Pose2& T_map_slam) { T_map_slam_ = T_map_slam; }

 private:
  AnchorConfig config_;
  Utime utime_ = kNever;
  Pose2 T_map_odom_;
  std::optional<Pose2> T_map_slam_;
};

}  // namespace rover::slam
