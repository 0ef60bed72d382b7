// What the supervisor uses of the messages: the newest of each stream, with the time of its measurement.
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
  bool usable = false;  // status tells of a position, all numbers finite
  double speed_mps = kNaN;
  double turn_rate_radps = kNaN;
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
  double tilt_rate_radps = 0.0;  // about the body's x and y
  double sigma_m = 0.0;          // of the horizontal position, larger axis
  double travelled_m = 0.0;
  Utime vo_utime = kNever;  // newest visual odometry in it
};

struct HazardsReport {
  Utime utime = kNever;
  bool blind = true;
  double coverage = 1.0;  // of the region of interest, by valid stereo
};

enum class PlannerState : std::int8_t { kIdle = 0, kFollowing = 1, kRepairing = 2, kNoPath = 3 };
enum class BlockKind : std::int8_t { kNone = 0, kHazard = 1, kUnseen = 2 };

struct PlannerReport {
  Utime utime = kNever;
  PlannerState state = PlannerState::kIdle;
  std::int64_t path_id = -1;
  double blocked_in_m = kNaN;
  BlockKind block_kind = BlockKind::kNone;
  double goal_distance_m = kNaN;
  int replans = 0;
};

struct ControlReport {
  Utime utime = kNever;
  bool path_end = false;
  bool out_of_corridor = false;
  bool stale_pose = false;  // nothing is predicted from it
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
  bool fault = false;               // by the driver's own word
  std::array<double, 6> drive_a{};  // FL FR ML MR RL RR
  std::array<double, 4> steer_a{};  // FL FR RL RR
  std::array<double, 6> drive_radps{};
};

struct ImuReport {
  Utime utime = kNever;
  bool fault = false;
};

// Of the Full level: cost map and what it says of the ground ahead.
struct TerrainReport {
  Utime utime = kNever;
  double difficulty = kNaN;  // 0 easy .. 1 hard
  KnownShares known;
  double travelled_m = 0.0;  // where it came
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
  std::int64_t received = 0;  // messages taken, over all inputs
  std::int64_t lost = 0;      // gaps, malformed
};

struct Inputs {
  PoseReport pose;
  HazardsReport hazards;
  int blind_in_a_row = 0;
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
