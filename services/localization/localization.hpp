// Where the rover is: T_odom_body from gyro, accelerometer, wheels and visual odometry, T_map_odom from the start pose
// and corrections.
//
// Every tick carries the pose on by gyro and wheels. A visual motion arrives some 0.2 s late; the state at its end is
// made anew from the state at its start, and what IMU and wheels measured since is applied again (fixed lag). The pose
// given out takes up the difference smoothly.
#pragma once

#include <deque>
#include <optional>
#include <string_view>

#include "common/core/vehicle.hpp"
#include "localization/checkpoint.hpp"
#include "localization/filter.hpp"
#include "localization/imu_monitor.hpp"
#include "localization/inputs.hpp"
#include "localization/levelling.hpp"
#include "localization/map_alignment.hpp"
#include "localization/motion_history.hpp"
#include "localization/slip_monitor.hpp"
#include "localization/visual_chain.hpp"
#include "localization/wheel_odometry.hpp"

namespace rover::loc {

// A recording of pictures without IMU and wheels. The attitude at the start, which gravity gives a rover, is told.
struct CamerasAloneConfig {
  bool enabled = false;
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
};

struct LocalizationConfig {
  FilterConfig filter;
  ImuMonitorConfig imu;
  LevellingConfig levelling;
  MapAlignmentConfig map;
  SlipConfig slip;
  double history_s = 60.0;                    // a visual motion may reach so far back
  double chain_s = 20.0;                      // longest run of visual motions taken as one
  double wheel_silence_s = 0.1;               // longer: the wheels are dead
  double visual_degraded_s = 1.5;             // without visual odometry: DEGRADED
  double blind_distance_m = 2.0;              // so far on wheels without visual odometry: LOST
  double imu_lost_s = 10.0;                   // without IMU: LOST
  double nothing_lost_s = 1.0;                // without wheels and visual odometry: LOST
  double standing_rate_radps = to_rad(0.15);  // gyro below, wheels still: the rover stands
  double standing_s = 0.4;                    // after so long
  double at_rest_s = 5.0;                     // after so long its body has stopped rocking
  double rest_rate_radps = to_rad(0.015);     // and its fibre-optic gyro is below that: 7 deviations of its noise
  double smoothing_s = 0.4;                   // time constant with which the pose takes up late corrections
  int conflicts_until_imu_suspect = 5;        // visual motions in a row that contradict the gyro
  double max_speed_mps = 20.0;                // a faster visual motion is nonsense
  CamerasAloneConfig cameras_alone;
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
  std::string_view reason;  // of a status that is not kOk
};

// Every take_... gives an empty text where the input is used, else why not.
class Localization {
 public:
  Localization(const LocalizationConfig& config, const Vehicle& vehicle);

  std::string_view take_imu(const ImuSample& sample);
  std::string_view take_wheels(const WheelSample& sample);
  std::string_view take_wheel_command(const WheelCommand& command);
  std::string_view take_visual(const VisualMotion& motion);
  std::string_view take_start_pose(const StartPose& start);
  std::string_view take_slam(const MapMeasurement& measurement);
  std::string_view take_correction(const MapMeasurement& measurement);

  // Carries the pose on with what came since the step before. Never waits: what is missing is bridged.
  void step(Utime now);

  const PoseEstimate& pose() const { return pose_; }
  Slip slip() const { return slip_.slip(history_.empty() ? 0 : history_.end()); }
  int conflicts() const { return conflicts_; }

  // Nothing before the rover is level.
  std::optional<Checkpoint> checkpoint() const;
  // Before the first step. What the wheels rolled since the checkpoint is taken from the encoders.
  void restore(const Checkpoint& checkpoint);

 private:
  struct Past {
    Utime utime;
    Eigen::Isometry3d T_odom_body;
  };

  bool is_future(Utime utime) const;
  std::optional<MotionRecord> next_record(Utime now);
  void gather_imu(MotionRecord& record);
  void gather_wheels(MotionRecord& record);
  void gather_command(MotionRecord& record) const;
  void judge_standing(MotionRecord& record);
  void initialise(const MotionRecord& record);
  void carry_on(const MotionRecord& record);
  FilterState carried(FilterState state, Utime to) const;
  // The record as the filter may use it.
  MotionRecord usable(const MotionRecord& record) const;
  double grip(const MotionRecord& record) const;
  bool gyro_suspect() const { return conflicts_in_a_row_ >= config_.conflicts_until_imu_suspect; }
  std::string_view use_visual(const VisualMotion& motion);
  std::optional<FilterState> fuse(const VisualChain& chain);
  void adopt(const FilterState& fused);
  Matrix6d cov_map() const;
  void publish_pose(const MotionRecord& record);
  void judge(Utime now);
  std::optional<Eigen::Isometry3d> pose_at(Utime utime) const;
  void start_covariance(const StartPose& start);

  LocalizationConfig config_;
  WheelOdometry wheels_;
  Filter filter_;
  ImuMonitor imu_monitor_;
  Levelling levelling_;
  MapAlignment map_;
  SlipMonitor slip_;
  MotionHistory history_;
  VisualChain chain_;

  std::deque<ImuSample> imu_waiting_;
  std::deque<WheelSample> wheels_waiting_;
  std::optional<WheelSample> last_wheels_;
  bool encoders_from_checkpoint_ = false;
  std::optional<WheelCommand> command_;
  Utime imu_newest_ = kNever;
  Utime wheels_newest_ = kNever;
  Utime visual_newest_ = kNever;
  Utime stepped_ = kNever;  // newest tick
  Utime record_end_ = kNever;
  Utime initialised_utime_ = kNever;
  Utime imu_alive_utime_ = kNever;
  double still_s_ = 0.0;                      // how long the wheels have stood
  double rest_s_ = 0.0;                       // of it, how long the body has not turned
  std::array<double, 6> still_turned_rad_{};  // what they turned since
  std::array<double, 4> still_steer_rad_{};   // how they were steered then

  bool initialised_ = false;
  FilterState latest_;  // at the newest visual motion, or where the wheels took over
  FilterState tip_;     // now
  Eigen::Vector3d visual_velocity_mps_ = Eigen::Vector3d::Zero();  // body axes, of the newest visual motion
  double blind_m_ = 0.0;                                           // rolled since the newest visual motion
  int conflicts_ = 0;
  int conflicts_in_a_row_ = 0;

  Eigen::Vector3d offset_m_ = Eigen::Vector3d::Zero();  // pose given out minus estimate
  Eigen::Vector3d offset_rad_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d last_vertex_m_ = Eigen::Vector3d::Zero();
  double travelled_m_ = 0.0;
  std::deque<Past> past_;
  PoseEstimate pose_;
};

}  // namespace rover::loc
