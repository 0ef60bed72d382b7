// Newest data of each input stream with its measurement time, reduced to what the supervisor needs.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>

#include "common/core/frames.hpp"
#include "common/core/time.hpp"
#include "supervisor/terrain_view.hpp"

namespace rover::supervisor {

struct PoseReport {
  Utime utime = kNever;
  bool usable = false;  // status OK or DEGRADED, all numbers finite
  Pose2 odom;
  double speed_mps = kNaN;
  double forward_mps = kNaN;
  double turn_rate_radps = kNaN;
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
  double tilt_rate_radps = 0.0;  // about body x and y
  double sigma_m = 0.0;          // horizontal position, larger axis
  double travelled_m = 0.0;
  Utime vo_utime = kNever;  // newest visual odometry used in the pose
};

struct HazardsReport {
  Utime utime = kNever;
  bool blind = true;
  double coverage = 1.0;  // fraction of the region of interest with valid stereo
};

enum class PlannerState : std::int8_t { kIdle = 0, kFollowing = 1, kRepairing = 2, kNoPath = 3 };

struct PlannerReport {
  Utime utime = kNever;
  PlannerState state = PlannerState::kIdle;
  std::int64_t path_id = -1;
  std::int64_t global_path_id = -1;
  double blocked_in_m = kNaN;
  double goal_distance_m = kNaN;
  int replans = 0;
};

struct ControlReport {
  Utime utime = kNever;
  bool path_end = false;
  bool out_of_corridor = false;
  bool stale_pose = false;  // no valid prediction
  std::int64_t path_id = -1;
  double cross_track_m = kNaN;
  double corridor_half_width_m = kNaN;
  double predicted_error_m = 0.0;  // largest cross track error expected ahead
  double arc_length_m = 0.0;       // along that path
};

struct SlipReport {
  Utime utime = kNever;
  bool valid = false;
  double ratio = kNaN;
};

struct WheelReport {
  Utime utime = kNever;
  bool fault = false;                       // reported by the driver, or non-finite values
  std::array<double, 6> drive_current_a{};  // FL FR ML MR RL RR
  std::array<double, 4> steer_current_a{};  // FL FR RL RR
  std::array<double, 6> drive_rate_radps{};
};

struct ImuReport {
  Utime utime = kNever;
  bool fault = false;
};

// Full level: summary of the costmap.
struct TerrainReport {
  Utime utime = kNever;
  double difficulty = kNaN;  // 0 easy .. 1 hard
  KnownFractions known;
  double travelled_m = 0.0;  // odometer when it arrived
};

struct SlamReport {
  Utime utime = kNever;
  bool lost = false;
};

enum class ServiceStatus : std::int8_t { kOk = 0, kDegraded = 1, kFault = 2 };

struct ServiceReport {
  Utime utime = kNever;
  std::int64_t boot_id = 0;
  int pid = 0;
  ServiceStatus status = ServiceStatus::kOk;
  std::int64_t received = 0;  // received messages over all inputs
  std::int64_t lost = 0;      // gaps, malformed
};

struct VisualReport {
  Utime utime = kNever;
  bool displaced = false;  // the cameras of the LocCam have moved against each other
};

struct Inputs {
  PoseReport pose;
  HazardsReport hazards;
  int consecutive_blind_frames = 0;
  Utime seen_utime = kNever;  // newest frame of HAZARDS that is not blind
  VisualReport visual;
  PlannerReport planner;
  ControlReport control;
  SlipReport slip;
  WheelReport wheels;
  ImuReport imu;
  TerrainReport terrain;
  SlamReport slam;
  Utime motion_command_utime = kNever;
  std::map<std::string, ServiceReport> services;
};

}  // namespace rover::supervisor
