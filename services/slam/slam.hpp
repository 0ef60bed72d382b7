// GA SLAM (Geromichalos, Azkarate et al. 2020): a particle filter matches each cloud against the elevation map, then
// inserts it.
//
// Frames: odom drifts; slam is fixed and equals odom at the first cloud; map is the orbital map's. T_slam_odom is the
// estimated drift of odometry; T_map_slam changes only by external corrections (MapAnchor).
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "slam/cloud.hpp"
#include "slam/elevation_map.hpp"
#include "slam/map_anchor.hpp"
#include "slam/match_error.hpp"
#include "slam/particle_filter.hpp"
#include "slam/scan_match.hpp"

namespace rover::slam {

struct MotionConfig {
  double along_sigma_per_m = 0.0015;  // standard deviation per metre driven, random part
  double across_sigma_per_m = 0.0015;
  double dead_reckoned_sigma_per_m = 0.08;  // same, both axes, per metre without visual odometry
  double scale_error_per_m = 0.01;          // growth of POSE's deviation per metre that is scale error, not noise
  double yaw_rad_per_m = to_rad(0.002);
  double yaw_sigma_ratio = 0.0001;                 // of the turn
  double gyro_bias_rad_per_sqrt_s = to_rad(0.01);  // growth of POSE's yaw deviation that is gyro bias, not noise
  double min_noise_m = 0.0005;                     // lower bound per cloud
};

struct JumpConfig {
  double max_speed_mps = 0.5;  // faster odometry has jumped
  double tolerance_m = 0.15;
  double max_rate_radps = to_rad(57.0);
  double tolerance_rad = to_rad(5.0);
};

// Growth of the error relative to the start: the particles measure it relative to the map only.
struct DriftConfig {
  double position_sigma_per_m = 0.003;
  double yaw_rad_per_sqrt_m = to_rad(0.02);
};

struct SlamConfig {
  ElevationConfig map;
  MatchConfig match;
  MatchErrorConfig match_error;
  FilterConfig filter;
  MotionConfig motion;
  AttitudeNoise attitude;
  JumpConfig jump;
  DriftConfig drift;
  AnchorConfig anchor;
  double min_inlier_ratio = 0.5;  // of the matched patches; fewer: lost
  int lost_clouds = 3;            // in a row: the map is restarted
  std::uint64_t seed = 1;
};

// POSE at the cloud's exposure.
struct Odometry {
  Eigen::Isometry3d T_odom_body = nan_pose();
  double position_sigma_m = 0.0;  // of the pose in map; only its growth is used
  double yaw_sigma_rad = 0.0;
  double dead_reckoned_m = 0.0;  // distance driven without visual odometry so far
  double travelled_m = 0.0;      // falls where localization begins anew, in another odom frame
};

enum class Status { kOk, kNoInformation, kLost };

struct SlamResult {
  std::string_view rejection;  // not empty: the cloud was rejected, all else is invalid
  Status status = Status::kLost;
  Pose2 T_slam_odom;
  Pose2 T_map_odom;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // of the body's x, y, yaw since the anchor, in map
  // 1 / standard deviation [1/m] of the weakest observable direction; 0: none, or x and y were not both observable
  // since visual odometry last had a gap.
  double information = 0.0;
  int particles = 0;
  bool inserted = false;  // into the map
};

// The map in the current odom frame, axes aligned with odom, centred on the rover.
struct OdomElevation {
  double cell_m = 0.0;
  CellIndex corner;             // cell with the smallest x and y, in odom's grid
  int cells = 0;                // each side
  std::vector<float> height_m;  // row by row, y ascending; NaN: never seen
  std::vector<float> sigma_m;
  std::vector<float> brightness;  // empty: no cloud had any
};

class Slam {
 public:
  explicit Slam(const SlamConfig& config);

  // Call for each POSE. True: an external correction changed map -> odom, and SLAM adopted it.
  bool add_pose(Utime utime, const Eigen::Isometry3d& T_map_odom, const Eigen::Isometry3d& T_odom_body);
  SlamResult step(const Cloud& cloud, const Odometry& odometry);
  OdomElevation elevation() const;
  // Drift of odometry: planar, and the height to add to odom's.
  Pose2 T_slam_odom() const;
  double height_offset_m() const { return z_m_ - previous_.T_odom_body.translation().z(); }
  const ElevationMap& map() const { return map_; }
  // Of the newest accepted cloud.
  const Odometry& odometry() const { return previous_; }
  bool running() const { return filter_.running(); }

  std::vector<std::uint8_t> save() const;
  // False without any change if the bytes are invalid or of another map size.
  bool restore(const std::vector<std::uint8_t>& bytes);

 private:
  struct MatchOutcome {
    Status status = Status::kNoInformation;
    double information = 0.0;
    bool position_observable = false;  // x and y
    Eigen::Vector3f plane = Eigen::Vector3f::Zero();
  };
  bool has_jumped(const Odometry& odometry, const Odometry& from, Utime dt) const;
  std::string_view rejection_of(const Cloud& cloud, const Odometry& odometry);
  bool has_left_map(const Odometry& odometry) const;
  bool is_of_new_odom(const Odometry& odometry) const;
  void start(const Odometry& odometry);
  double yaw_noise_rad(const Odometry& odometry, Utime dt) const;
  void predict(const Odometry& odometry, Utime utime, Random& random);
  MatchOutcome match_cloud(const AlignedCloud& cloud, Random& random);
  // x and y, if the heading is known (gyro).
  bool position_observable(const MatchInformation& info) const;
  void learn_match_error(const Pose2& matched, const MatchInformation& info);
  void insert_cloud(AlignedCloud cloud, const MatchOutcome& match);
  void anchor();
  Eigen::Matrix3d covariance() const;

  SlamConfig config_;
  ElevationMap map_;
  PatchBinner binner_;
  ScanMatcher matcher_;
  MatchError match_error_;
  ParticleFilter filter_;
  MapAnchor anchor_;
  Utime utime_ = kNever;  // of the newest accepted cloud
  Odometry previous_;
  std::optional<Odometry> jump_candidate_;  // pose after a jump, until the next cloud confirms it
  Utime jump_utime_ = kNever;
  double gap_at_m_ = 0.0;        // distance travelled at the newest gap of visual odometry
  bool gap_unmeasured_ = false;  // since it x and y were not both observable
  double growth_per_m_ = 0.0;    // of odometry's standard deviation since the cloud before
  double z_m_ = 0.0;             // of the body in the slam frame
  double travelled_m_ = 0.0;
  double anchor_travelled_m_ = 0.0;
  int lost_count_ = 0;
};

}  // namespace rover::slam
