// Fixed-lag state estimation: T_odom_body from gyro, accelerometer, wheel and visual odometry; T_map_odom from the
// start pose, SLAM and global corrections.
//
// Each tick propagates the pose with gyro and wheels. A visual motion arrives about 0.2 s late: it is fused at its own
// time, and the IMU and wheel records since then are propagated again. The published pose absorbs the step smoothly.
#pragma once

#include <deque>
#include <optional>
#include <string_view>

#include "common/core/vehicle.hpp"
#include "localization/checkpoint.hpp"
#include "localization/filter.hpp"
#include "localization/imu_monitor.hpp"
#include "localization/inputs.hpp"
#include "localization/map_alignment.hpp"
#include "localization/motion_history.hpp"
#include "localization/slip_monitor.hpp"
#include "localization/static_alignment.hpp"
#include "localization/visual_chain.hpp"
#include "localization/wheel_odometry.hpp"

namespace rover::loc {

// For recordings without IMU and wheels: the initial attitude is configured instead of measured.
struct CameraOnlyConfig {
  bool enabled = false;
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
};

struct StationaryConfig {
  double rate_radps = to_rad(0.15);           // stationary: body rate below this and wheels still
  double after_s = 0.4;                       // for this long
  double settled_after_s = 5.0;               // the body has stopped rocking after this long
  double settled_rate_radps = to_rad(0.015);  // with the fibre-optic gyro below this (7 sigma of its noise)
};

struct StatusConfig {
  double wheel_timeout_s = 0.1;          // wheel encoders count as failed after this long without a sample
  double visual_degraded_s = 1.5;        // without visual odometry: DEGRADED
  double max_dead_reckoned_m = 2.0;      // distance without visual odometry and SLAM; more: LOST
  double imu_lost_s = 10.0;              // without IMU: LOST
  double no_odometry_lost_s = 1.0;       // without wheels and visual odometry: LOST
  int conflicts_until_gyro_suspect = 5;  // visual motions that contradict the gyro, without one as long that agrees
};

struct LocalizationConfig {
  FilterConfig filter;
  ImuMonitorConfig imu;
  StaticAlignmentConfig static_alignment;
  MapAlignmentConfig map;
  SlipConfig slip;
  StationaryConfig stationary;
  StatusConfig status;
  double history_s = 60.0;      // maximum age of a visual motion
  double chain_s = 20.0;        // longest sequence of visual motions fused as one measurement
  double smoothing_s = 0.4;     // time constant with which the pose absorbs late updates
  double max_speed_mps = 20.0;  // faster visual motions are rejected
  CameraOnlyConfig camera_only;
};

enum class PoseStatus { kOk, kDegraded, kLost, kUninitialised };

struct PoseEstimate {
  PoseStatus status = PoseStatus::kUninitialised;  // read first
  Utime utime = kNever;
  Eigen::Isometry3d T_odom_body = nan_pose();
  Eigen::Isometry3d T_map_odom = nan_pose();
  Matrix6d cov = nan_cov();  // of T_map_body: x y z, rotation; map axes
  Eigen::Vector3d velocity_body_mps = Eigen::Vector3d::Constant(kNaN);
  Eigen::Vector3d rate_body_radps = Eigen::Vector3d::Constant(kNaN);
  double travelled_m = 0.0;
  Utime last_vo_utime = kNever;
  std::string_view reason;  // why the status is not kOk
};

// Inputs return an empty text if accepted, otherwise the reason for the rejection.
class Localization {
 public:
  Localization(const LocalizationConfig& config, const Vehicle& vehicle);

  std::string_view add_imu(const ImuSample& sample);
  std::string_view add_wheels(const WheelSample& sample);
  std::string_view add_wheel_command(const WheelCommand& command);
  std::string_view add_visual_motion(const VisualMotion& motion);
  std::string_view set_start_pose(const StartPose& start);
  std::string_view add_slam_pose(const MapMeasurement& measurement);
  std::string_view apply_correction(const MapMeasurement& measurement);

  // Propagates the pose with the inputs since the last step. Never waits: missing inputs are bridged.
  void step(Utime now);

  const PoseEstimate& pose() const { return pose_; }
  Slip slip() const { return slip_.slip(history_.empty() ? 0 : history_.end()); }
  int gyro_conflicts() const { return gyro_conflicts_; }

  // Empty before static alignment.
  std::optional<Checkpoint> checkpoint() const;
  // Call before the first step. The encoders give the wheel travel since the checkpoint.
  void restore(const Checkpoint& checkpoint);

 private:
  struct StampedPose {
    Utime utime;
    Eigen::Isometry3d T_odom_body;
  };

  bool is_future(Utime utime) const;
  std::optional<MotionRecord> next_record(Utime now);
  void integrate_imu(MotionRecord& record);
  void integrate_wheels(MotionRecord& record);
  void integrate_command(MotionRecord& record) const;
  void detect_stationary(MotionRecord& record);
  void initialise(const MotionRecord& record);
  void predict(const MotionRecord& record);
  FilterState propagate_to(FilterState state, Utime to) const;
  MotionRecord without_suspect_gyro(const MotionRecord& record) const;
  // Of the ground point, body axes: wheels and slip.
  Eigen::Vector2d ground_motion(const MotionRecord& record) const;
  bool gyro_suspect() const { return consecutive_conflicts_ >= config_.status.conflicts_until_gyro_suspect; }
  void fuse_slam(Utime now);
  std::string_view fuse_visual_motion(const VisualMotion& motion);
  std::optional<FilterState> fuse_chain(const VisualChain& chain);
  void apply_fused_state(const FilterState& fused);
  Matrix6d cov_map() const;
  void update_pose(const MotionRecord& record);
  void update_status(Utime now);
  std::optional<Eigen::Isometry3d> pose_at(Utime utime) const;
  void reset_covariance(const StartPose& start);

  LocalizationConfig config_;
  WheelOdometry wheels_;
  Eigen::Vector3d ground_m_;  // the point of the body on the ground below its origin; a recording has none
  Filter filter_;
  ImuMonitor imu_monitor_;
  StaticAlignment static_alignment_;
  MapAlignment map_;
  SlipMonitor slip_;
  MotionHistory history_;
  VisualChain chain_;

  std::deque<ImuSample> imu_queue_;
  std::deque<WheelSample> wheel_queue_;
  std::optional<WheelSample> last_wheels_;
  bool encoders_from_checkpoint_ = false;
  bool wheels_bridged_ = false;  // by the visual velocity, since last_wheels_
  std::optional<WheelCommand> command_;
  Utime newest_imu_utime_ = kNever;
  Utime newest_wheels_utime_ = kNever;
  Utime newest_visual_utime_ = kNever;
  Utime newest_tick_utime_ = kNever;
  Utime last_record_end_ = kNever;
  Utime initialised_utime_ = kNever;
  Utime imu_healthy_utime_ = kNever;
  double stationary_s_ = 0.0;                      // time since the wheels last moved
  double settled_s_ = 0.0;                         // time since the body last rotated
  std::array<double, 6> turned_since_stop_rad_{};  // wheel rotation since the last movement
  std::array<double, 4> steer_at_stop_rad_{};      // steering angles at the last movement

  bool initialised_ = false;
  FilterState fused_;                                              // at the newest visual motion, or motion by SLAM
  FilterState predicted_;                                          // at the newest record
  Eigen::Vector3d visual_velocity_mps_ = Eigen::Vector3d::Zero();  // of the ground point, by the newest visual motion
  int gyro_conflicts_ = 0;
  int consecutive_conflicts_ = 0;
  double conflict_span_s_ = 0.0;  // of the shortest of them

  Eigen::Vector3d smoothing_offset_m_ = Eigen::Vector3d::Zero();  // published pose minus estimate
  Eigen::Vector3d smoothing_offset_rad_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d last_chord_end_m_ = Eigen::Vector3d::Zero();
  double travelled_m_ = 0.0;
  std::deque<StampedPose> poses_;
  std::deque<MapMeasurement> slam_queue_;  // until odometry at their times is settled
  PoseEstimate pose_;
};

}  // namespace rover::loc
