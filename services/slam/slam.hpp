// Globally adaptive SLAM (Geromichalos, Azkarate et al. 2020): one cloud after the other is weighed by particles
// against the map as it was before, and then laid into it.
//
// Three frames: odom drifts; `slam` is the map's own, odom's at the first cloud, in which nothing is ever moved; map is
// the orbital one. T_slam_odom is what the matching has found of odometry's drift; T_map_slam changes only by
// corrections from elsewhere (MapAnchor).
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "slam/cloud.hpp"
#include "slam/elevation_map.hpp"
#include "slam/map_anchor.hpp"
#include "slam/particle_filter.hpp"
#include "slam/scan_match.hpp"

namespace rover::slam {

struct MotionConfig {
  double along_share = 0.0015;  // standard deviation by the way driven, at random
  double across_share = 0.0015;
  double blind_share = 0.08;  // likewise, both ways, by the way on which wheels alone told
  double scale_share = 0.01;  // of the way, by which the told deviation may grow without being noise
  double yaw_rad_per_m = to_rad(0.002);
  double yaw_share = 0.0001;               // of the turn
  double slow_yaw_rad_rts = to_rad(0.01);  // by which the told deviation may grow without being noise: the gyro's bias
  double still_m = 0.0005;                 // least, in each cloud
  double height_share = 0.01;
};

struct JumpConfig {
  double top_speed_mps = 0.5;  // odometry that moves faster has jumped
  double slack_m = 0.15;
  double top_rate_radps = 1.0;
  double slack_rad = to_rad(5.0);
};

// What one metre on adds to the error against the start: map and particles know nothing of it.
struct DriftConfig {
  double position_share = 0.003;
  double yaw_rad_per_sqrt_m = to_rad(0.02);
};

struct SlamConfig {
  ElevationConfig map;
  MatchConfig match;
  FilterConfig filter;
  MotionConfig motion;
  AttitudeNoise attitude;
  JumpConfig jump;
  DriftConfig drift;
  AnchorConfig anchor;
  double min_fitting_share = 0.5;  // of the matched patches: fewer, and cloud and map are of different ground
  int lost_clouds = 3;             // one after the other: the map is begun anew
  std::uint64_t seed = 1;
};

// POSE at the cloud's exposure.
struct Odometry {
  Eigen::Isometry3d T_odom_body = nan_pose();
  double position_sigma_m = 0.0;  // of the pose in map; only its growth counts
  double yaw_sigma_rad = 0.0;
  double blind_way_m = 0.0;  // of the way so far, that without visual odometry
};

enum class Status { kOk, kNoInformation, kLost };

struct SlamResult {
  std::string_view refusal;  // not empty: the cloud was not taken, and nothing else holds
  Status status = Status::kLost;
  Pose2 T_slam_odom;
  Pose2 T_map_odom;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // of the body, x, y, yaw, since the anchor, in map's axes
  double information = 0.0;  // 1 / standard deviation [1/m] of the weakest direction that was measured; 0: none
  int particles = 0;
};

// The map as it lies in odom now, aligned with odom, the rover in its middle.
struct OdomElevation {
  double cell_m = 0.0;
  CellIndex corner;             // of the lattice of odom, smallest x and y
  int cells = 0;                // each side
  std::vector<float> height_m;  // rows of growing y; NaN: never seen
  std::vector<float> sigma_m;
};

class Slam {
 public:
  explicit Slam(const SlamConfig& config);

  // Each POSE, for how map lies to odom. True where something else than SLAM has moved map, and SLAM begins anew from
  // it.
  bool take_pose(Utime utime, const Eigen::Isometry3d& T_map_odom, const Eigen::Isometry3d& T_odom_body);
  SlamResult step(const Cloud& cloud, const Odometry& odometry);
  OdomElevation elevation() const;
  // Planar, and the height that has to be added to odom's.
  Pose2 T_slam_odom() const;
  double height_offset_m() const { return z_m_ - last_.T_odom_body.translation().z(); }
  const ElevationMap& map() const { return map_; }
  bool running() const { return filter_.running(); }
  double way_m() const { return way_m_; }

  std::vector<std::uint8_t> save() const;
  // False, and nothing changed, where the bytes are not of a slam like this one.
  bool restore(const std::vector<std::uint8_t>& bytes);

 private:
  struct Weighed {
    Status status = Status::kNoInformation;
    double information = 0.0;
    Eigen::Vector3f plane = Eigen::Vector3f::Zero();
  };
  bool has_jumped(const Odometry& odometry, const Odometry& from, Utime dt) const;
  std::string_view refusal_of(const Cloud& cloud, const Odometry& odometry);
  bool has_left_map(const Odometry& odometry) const;
  void start(const Odometry& odometry);
  double yaw_noise_rad(const Odometry& odometry, Utime dt) const;
  void predict(const Odometry& odometry, Utime utime, Random& random);
  Weighed weigh(const LevelCloud& cloud, Random& random);
  void lay(LevelCloud cloud, const Weighed& weighed);
  void anchor();
  Eigen::Matrix3d covariance() const;

  SlamConfig config_;
  ElevationMap map_;
  PatchGatherer gatherer_;
  ScanMatcher matcher_;
  ParticleFilter filter_;
  MapAnchor anchor_;
  Utime utime_ = kNever;  // of the newest cloud taken
  Odometry last_;
  std::optional<Odometry> suspect_;  // after a jump, until the next cloud says which of the two holds
  Utime suspect_utime_ = kNever;
  double z_m_ = 0.0;  // of the body in slam
  double way_m_ = 0.0;
  double anchor_way_m_ = 0.0;
  int lost_ = 0;
};

}  // namespace rover::slam
