// Follows a path inside its safety corridor with arcs and point turns. No fresh pose, no motion.
#pragma once

#include <cstdint>
#include <optional>

#include "common/core/frames.hpp"
#include "common/core/time.hpp"
#include "locomotion/lease.hpp"
#include "trajectory_control/steering_law.hpp"
#include "trajectory_control/tracked_path.hpp"

namespace rover::control {

using locomotion::DrivePermit;
using locomotion::MotionCommand;
using locomotion::MotionMode;

struct TrajectoryControlConfig {
  TrackedPathConfig path;
  SteeringLawConfig steering;
  double pose_max_age_s = 0.2;
  double permit_max_age_s = 0.2;
  double command_validity_s = 0.2;
  double response_delay_s = 0.2;  // from pose to the wheels' answer: three ticks and the steering's lag
  double end_tolerance_m = 0.03;  // a stop from the speed there takes about this way
  double creep_speed_mps = 0.02;  // to the very end
  double steering_way_m = 0.25;   // passed at most while the steering comes to the wanted curvature
  double turn_start_rad = 0.698;  // 40 deg: heading error that calls for a point turn
  double turn_stop_rad = 0.035;   // 2 deg
  double max_turn_rate_radps = 0.2;
  double turn_deceleration_radps2 = 0.1;
  double look_ahead_m = 1.5;      // of the predicted corridor error
  double side_slip_time_s = 1.0;  // low pass of the measured side slip
  double teleop_max_age_s = 0.5;  // of the operator's newest command
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
  bool usable = false;  // status tells of a position
  Pose2 odom;           // body in odom
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

  // Replaces the path, also at speed. False: not a path, and the rover has none from now on.
  bool set_path(const PathInput& input);
  // One tick; pose and permit are the newest received.
  ControlOutput step(Utime now, const PoseInput& pose, const DrivePermit& permit);

 private:
  ControlOutput step_ahead(Utime now, const PoseInput& pose, const DrivePermit& permit);
  void set_direction(bool backwards);
  bool is_fresh(const PoseInput& pose, Utime now) const;
  const Leg& leg() const { return path_->legs()[place_.leg]; }
  bool on_last_leg() const { return place_.leg + 1 == path_->legs().size(); }
  Projection advance_on_path(const Pose2& pose);
  bool update_turning(const ControlOutput& out, double forward_mps);
  void follow(const PoseInput& pose, const Projection& here, double dt_s, double max_speed_mps, MotionCommand& command);
  double speed_while_steering(double curvature_per_m, double wanted_per_m) const;
  void integrate(double cross_track_m, double way_m);
  void turn(double heading_error_rad, MotionCommand& command) const;
  void update_side_slip(const PoseInput& pose, double dt_s);
  double curvature_at(const Pose2& pose, const Projection& place) const;
  double predict_corridor_error(const Pose2& pose, const Projection& here) const;

  TrajectoryControlConfig config_;
  std::optional<TrackedPath> path_;
  PathInput input_;
  bool relocate_ = false;
  bool turning_ = false;
  Place place_;
  double curvature_per_m_ = 0.0;  // the steering's, as the commands and its rate make it
  double integral_per_m_ = 0.0;
  double side_slip_rad_ = 0.0;
  bool backwards_ = false;  // curvature, integral and side slip are those of a rover whose stern is its bow
  Utime last_step_ = kNever;
};

}  // namespace rover::control
