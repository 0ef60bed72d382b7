// Path-following controller: keeps the rover inside its safety corridor with arcs and point turns. Without a fresh pose
// it commands no motion.
#pragma once

#include <cstdint>
#include <optional>

#include "common/core/frames.hpp"
#include "common/core/lease.hpp"
#include "common/core/time.hpp"
#include "trajectory_control/steering_law.hpp"
#include "trajectory_control/tracked_path.hpp"

namespace rover::control {

struct TrajectoryControlConfig {
  double origin_height_m = 0.0;  // of the body origin above the ground
  TrackedPathConfig path;
  SteeringLawConfig steering;
  double pose_max_age_s = 0.2;
  double permit_max_age_s = 0.2;
  double command_validity_s = 0.2;
  double response_delay_s = 0.2;         // from pose to wheel response: three ticks plus steering lag
  double end_tolerance_m = 0.03;         // about the stopping distance from the speed there
  double creep_speed_mps = 0.02;         // minimum speed, also just before the end
  double steering_distance_m = 0.25;     // travelled at most while the steering reaches the commanded curvature
  double turn_start_rad = to_rad(40.0);  // heading error that starts a point turn
  double turn_stop_rad = to_rad(2.0);
  double max_turn_rate_radps = to_rad(13.0);
  double turn_deceleration_radps2 = to_rad(5.7);
  double look_ahead_m = 1.5;      // prediction horizon of the corridor error
  double side_slip_time_s = 1.0;  // low-pass time constant of the measured side slip
  double teleop_max_age_s = 0.5;  // of the newest operator command
};

enum class ControlState : std::int8_t {
  kIdle = 0,
  kFollowing = 1,
  kPointTurn = 2,
  kPathEnd = 3,
  kStalePose = 4,
  kOutOfCorridor = 5,
  kNoPermit = 6,
};

struct PoseInput {
  Utime utime = kNever;
  bool usable = false;  // pose status is OK or DEGRADED
  Pose2 odom;           // body in the odom frame
  double forward_mps = 0.0;
  double left_mps = 0.0;
};

struct ControlOutput {
  ControlState state = ControlState::kIdle;
  std::int64_t path_id = -1;
  double arc_length_m = kNaN;
  double remaining_m = kNaN;
  double cross_track_m = kNaN;
  double heading_error_rad = kNaN;
  double predicted_corridor_error_m = kNaN;
  double corridor_half_width_m = kNaN;
  MotionCommand command;
};

class TrajectoryController {
 public:
  explicit TrajectoryController(const TrajectoryControlConfig& config) : config_(config) {}

  // Replaces the path, also while moving. False: the path is invalid and the old one is removed.
  bool set_path(const PathInput& input);
  // The operator's commands are driven instead: the cross track says nothing about the steering law.
  void set_teleoperated(bool teleoperated) { teleoperated_ = teleoperated; }
  // One control tick; pose and permit are the newest received.
  ControlOutput step(Utime now, const PoseInput& pose, const DrivePermit& permit);

 private:
  void follow(const PoseInput& pose, const Projection& projection, double dt_s, const DrivePermit& permit,
              ControlOutput& out);
  void set_reverse(bool reverse);
  bool is_fresh(const PoseInput& pose, Utime now) const;
  const PathSegment& segment() const { return path_->segments()[path_position_.segment]; }
  bool on_last_segment() const { return path_position_.segment + 1 == path_->segments().size(); }
  Projection advance_on_path(const Pose2& pose);
  bool update_point_turn(const ControlOutput& out, double forward_mps);
  void follow_arc(const PoseInput& pose, const Projection& projection, double dt_s, double max_speed_mps,
                  MotionCommand& command);
  double speed_while_steering(double curvature_per_m, double commanded_per_m) const;
  void integrate(double cross_track_m, double distance_m);
  void point_turn(double heading_error_rad, MotionCommand& command) const;
  void update_side_slip(const PoseInput& pose, double dt_s);
  double curvature_command(const Pose2& pose, const Projection& foot_point) const;
  double predict_corridor_error(const Pose2& pose, const Projection& projection) const;

  TrajectoryControlConfig config_;
  std::optional<TrackedPath> path_;
  PathInput input_;
  bool relocate_ = false;
  bool teleoperated_ = false;
  bool turning_ = false;
  PathPosition path_position_;
  double steering_curvature_per_m_ = 0.0;  // modelled steering: commands with a rate limit
  double integral_per_m_ = 0.0;
  double side_slip_rad_ = 0.0;
  bool reverse_ = false;  // of the segment; curvature, integral and side slip refer to a body rotated by 180 deg
  Utime last_step_ = kNever;
};

}  // namespace rover::control
