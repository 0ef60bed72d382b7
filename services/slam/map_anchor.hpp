// T_map_slam: pose of SLAM's own frame in map. Localization applies SLAM's measurements to map -> odom at a limited
// rate; a faster change is an external correction. SLAM adopts it here, so that it never undoes a correction.
#pragma once

#include <optional>

#include "common/core/frames.hpp"
#include "common/core/time.hpp"

namespace rover::slam {

struct AnchorConfig {
  double slew_mps = 0.03;  // above localization's slew limits for SLAM, 0.02 m/s and 0.3 deg/s
  double slew_radps = to_rad(0.45);
  double tolerance_m = 0.0005;
  double tolerance_rad = 1e-5;
};

class MapAnchor {
 public:
  // For the checkpoint.
  struct State {
    Utime utime = kNever;  // of the newest POSE
    Pose2 T_map_odom;
    Pose2 T_map_slam;
  };

  explicit MapAnchor(const AnchorConfig& config) : config_(config) {}

  // Call for each POSE. True: map -> odom was changed by an external correction.
  bool add_pose(Utime utime, const Eigen::Isometry3d& T_map_odom, const Eigen::Isometry3d& T_odom_body);
  // Sets T_map_slam so that SLAM agrees with the newest POSE, given the drift `T_slam_odom`.
  void anchor(const Pose2& T_slam_odom);
  // Both require an anchor.
  Pose2 T_map_odom(const Pose2& T_slam_odom) const;
  Pose2 T_map_slam() const { return *T_map_slam_; }
  State state() const { return {utime_, T_map_odom_, T_map_slam_.value_or(Pose2{})}; }
  void restore(const State& state);

 private:
  AnchorConfig config_;
  Utime utime_ = kNever;
  Pose2 T_map_odom_;
  std::optional<Pose2> T_map_slam_;
};

}  // namespace rover::slam
