#include "trajectory_control/trajectory_controller.hpp"

#include <algorithm>
#include <cmath>

namespace rover::control {
namespace {

constexpr double kMaxStepS = 0.1;     // limits the time step after a gap in the ticks
constexpr double kSearchBackM = 0.3;  // search window for the closest point
constexpr double kSearchAheadM = 0.5;
constexpr double kPredictionStepM = 0.1;
constexpr double kMinSlipSpeedMps = 0.03;  // below it the direction of motion is noise
constexpr double kMaxSideSlipRad = 0.35;
constexpr double kStationaryMps = 0.02;
constexpr double kSlowMps = 0.1;             // stops within 0.05 m
constexpr double kStationaryFraction = 0.8;  // of the corridor half width
constexpr double kMinTurnRad = 0.175;        // 10 deg: smaller heading errors do not cause a corridor violation

Pose2 propagate(const Pose2& pose, double distance_m, double curvature_per_m, double side_slip_rad) {
  const double mid_yaw_rad = pose.yaw_rad + 0.5 * distance_m * curvature_per_m;
  return {pose.x_m + distance_m * std::cos(mid_yaw_rad + side_slip_rad),
          pose.y_m + distance_m * std::sin(mid_yaw_rad + side_slip_rad), pose.yaw_rad + distance_m * curvature_per_m};
}

Eigen::Vector2d point_of(const Pose2& pose) {
  return {pose.x_m, pose.y_m};
}

// Reverse driving is forward driving of a body rotated by 180 deg.
PoseInput reversed(PoseInput pose) {
  pose.odom.yaw_rad = wrap_angle(pose.odom.yaw_rad + kPi);
  pose.forward_mps = -pose.forward_mps;
  pose.left_mps = -pose.left_mps;
  return pose;
}

double move_towards(double from, double to, double step) {
  return from + std::clamp(to - from, -step, step);
}

}  // namespace

bool TrajectoryController::set_path(const PathInput& input) {
  if (path_ && input.id == input_.id && input.reverse == input_.reverse && input.points == input_.points) return true;
  input_ = input;
  path_ = TrackedPath::build(input, config_.path);
  relocate_ = true;
  return path_.has_value();
}

void TrajectoryController::set_reverse(bool reverse) {
  if (reverse == reverse_) return;
  reverse_ = reverse;
  steering_curvature_per_m_ = -steering_curvature_per_m_;
  integral_per_m_ = -integral_per_m_;
  side_slip_rad_ = -side_slip_rad_;
}

ControlOutput TrajectoryController::step(Utime now, const PoseInput& pose, const DrivePermit& permit) {
  const double dt_s = last_step_ == kNever ? 0.0 : std::min(to_seconds(now - last_step_), kMaxStepS);
  last_step_ = now;
  ControlOutput out;
  out.command.utime = now;
  out.command.valid_until = now;  // STOP without a lease unless all checks below pass
  if (path_) {
    out.path_id = path_->id();
    out.corridor_half_width_m = path_->corridor_half_width_m();
  }
  if (!is_fresh(pose, now)) {
    out.state = ControlState::kStalePose;
    return out;
  }
  const Projection projection = path_ ? advance_on_path(pose.odom) : Projection();
  const PoseInput leading = reverse_ ? reversed(pose) : pose;
  update_side_slip(leading, dt_s);
  if (path_) follow(leading, projection, dt_s, permit, out);
  if (reverse_) {
    out.command.speed_mps = -out.command.speed_mps;
    out.command.curvature_per_m = -out.command.curvature_per_m;
  }
  return out;
}

// The pose is that of the end which leads.
void TrajectoryController::follow(const PoseInput& pose, const Projection& projection, double dt_s,
                                  const DrivePermit& permit, ControlOutput& out) {
  out.arc_length_m = segment().start_m() + projection.s_m;
  out.remaining_m = path_->length_m() - out.arc_length_m - std::max(projection.beyond_m, 0.0);
  out.cross_track_m = segment().cross_track_m(point_of(pose.odom), projection.s_m);
  out.heading_error_rad = wrap_angle(pose.odom.yaw_rad - projection.yaw_rad);
  out.predicted_corridor_error_m = predict_corridor_error(pose.odom, projection);
  if (std::abs(out.cross_track_m) > path_->corridor_half_width_m()) {
    out.state = ControlState::kOutOfCorridor;
    return;
  }
  const Utime now = out.command.utime;
  const Utime valid_until = now + to_utime(config_.command_validity_s);
  if (on_last_segment() && out.remaining_m <= config_.end_tolerance_m) {
    out.state = ControlState::kPathEnd;
    out.command.valid_until = valid_until;
    return;
  }
  if (!permit_valid(permit, now, to_utime(config_.permit_max_age_s))) {
    out.state = ControlState::kNoPermit;
    return;
  }
  out.command.valid_until = valid_until;
  if (update_point_turn(out, pose.forward_mps)) {
    out.state = ControlState::kPointTurn;
    point_turn(out.heading_error_rad, out.command);
  } else {
    out.state = ControlState::kFollowing;
    follow_arc(pose, projection, dt_s, permit.max_speed_mps, out.command);
  }
}

bool TrajectoryController::is_fresh(const PoseInput& pose, Utime now) const {
  return pose.usable && pose.utime >= 0 && pose.utime <= now && now - pose.utime <= to_utime(config_.pose_max_age_s) &&
         std::isfinite(pose.odom.x_m) && std::isfinite(pose.odom.y_m) && std::isfinite(pose.odom.yaw_rad) &&
         std::isfinite(pose.forward_mps) && std::isfinite(pose.left_mps);
}

Projection TrajectoryController::advance_on_path(const Pose2& pose) {
  if (relocate_) path_position_ = path_->locate(pose);
  relocate_ = false;
  Projection projection =
      segment().project(point_of(pose), path_position_.s_m - kSearchBackM, path_position_.s_m + kSearchAheadM);
  const double remaining_m = segment().length_m() - projection.s_m - std::max(projection.beyond_m, 0.0);
  if (!on_last_segment() && remaining_m <= config_.end_tolerance_m) {
    ++path_position_.segment;
    turning_ = segment().reverse() == reverse_;  // at a corner, not at a cusp
    projection = segment().project(point_of(pose), 0.0, kSearchAheadM);
  }
  path_position_.s_m = projection.s_m;
  set_reverse(segment().reverse());
  return projection;
}

// A slow or stationary rover that would leave its corridor on the first arc also turns on the spot, because the
// supervisor would stop it. If stationary, a margin (kStationaryFraction) covers the growth over the first metre.
bool TrajectoryController::update_point_turn(const ControlOutput& out, double forward_mps) {
  const double speed_mps = std::abs(forward_mps);
  const double width_fraction = speed_mps < kStationaryMps ? kStationaryFraction : 1.0;
  const bool would_leave_corridor =
      speed_mps < kSlowMps && out.predicted_corridor_error_m > width_fraction * out.corridor_half_width_m;
  const double start_rad = would_leave_corridor ? kMinTurnRad : config_.turn_start_rad;
  turning_ = std::abs(out.heading_error_rad) > (turning_ ? config_.turn_stop_rad : start_rad);
  return turning_;
}

void TrajectoryController::point_turn(double heading_error_rad, MotionCommand& command) const {
  const double rate = std::min(config_.max_turn_rate_radps,
                               std::sqrt(2.0 * config_.turn_deceleration_radps2 * std::abs(heading_error_rad)));
  command.mode = MotionMode::kPointTurn;
  command.turn_rate_radps = -std::copysign(rate, heading_error_rad);
}

void TrajectoryController::follow_arc(const PoseInput& pose, const Projection& projection, double dt_s,
                                      double max_speed_mps, MotionCommand& command) {
  const double speed_mps = std::clamp(pose.forward_mps, 0.0, config_.path.cruise_speed_mps);
  const double delay_distance_m = speed_mps * config_.response_delay_s;
  const Pose2 predicted = propagate(pose.odom, delay_distance_m, steering_curvature_per_m_, side_slip_rad_);
  const Projection predicted_projection =
      segment().project(point_of(predicted), projection.s_m - kSearchBackM, projection.s_m + kSearchAheadM);
  command.mode = MotionMode::kArc;
  command.curvature_per_m = curvature_command(predicted, predicted_projection);
  const double profile = std::max(segment().at(predicted_projection.s_m).speed_mps, config_.creep_speed_mps);
  command.speed_mps =
      std::min({profile, max_speed_mps, speed_while_steering(steering_curvature_per_m_, command.curvature_per_m)});

  steering_curvature_per_m_ =
      move_towards(steering_curvature_per_m_, command.curvature_per_m, config_.path.max_curvature_rate * dt_s);
  if (!teleoperated_) integrate(projection.cross_track_m, speed_mps * dt_s);
}

// Limits the distance travelled (steering_distance_m) while the slow steering reaches the commanded curvature.
double TrajectoryController::speed_while_steering(double curvature_per_m, double commanded_per_m) const {
  const double steering_time_s = std::abs(commanded_per_m - curvature_per_m) / config_.path.max_curvature_rate;
  return std::max(config_.steering_distance_m / std::max(steering_time_s, 1e-3), config_.creep_speed_mps);
}

// Anti-windup: errors are clamped, so a large initial offset causes no overshoot.
void TrajectoryController::integrate(double cross_track_m, double distance_m) {
  const SteeringLawConfig& c = config_.steering;
  const double clamped_m = std::clamp(cross_track_m, -c.max_integrated_m, c.max_integrated_m);
  integral_per_m_ += c.integral_per_m3 * clamped_m * distance_m;
  integral_per_m_ = std::clamp(integral_per_m_, -c.max_integral_per_m, c.max_integral_per_m);
}

// Uses the direction of motion, not the heading, because the rover side-slips on slopes.
double TrajectoryController::curvature_command(const Pose2& pose, const Projection& foot_point) const {
  const TrackError error{foot_point.cross_track_m, wrap_angle(pose.yaw_rad + side_slip_rad_ - foot_point.yaw_rad)};
  return steering_law(config_.steering, segment().at(foot_point.s_m).curvature_per_m, error, integral_per_m_);
}

void TrajectoryController::update_side_slip(const PoseInput& pose, double dt_s) {
  if (pose.forward_mps < kMinSlipSpeedMps) return;
  const double measured_rad =
      std::clamp(std::atan2(pose.left_mps, pose.forward_mps), -kMaxSideSlipRad, kMaxSideSlipRad);
  side_slip_rad_ += (measured_rad - side_slip_rad_) * std::min(1.0, dt_s / config_.side_slip_time_s);
}

// Simulates the control law over look_ahead_m with rate-limited steering and the measured side slip.
double TrajectoryController::predict_corridor_error(const Pose2& pose, const Projection& projection) const {
  Pose2 p = pose;
  Projection foot_point = projection;
  double curvature = steering_curvature_per_m_;
  double largest_m = std::abs(segment().cross_track_m(point_of(p), projection.s_m));
  // A point turn comes first and does not change the position.
  if (turning_ || std::abs(wrap_angle(pose.yaw_rad - projection.yaw_rad)) > config_.turn_start_rad) return largest_m;
  for (double distance_m = 0.0; distance_m < config_.look_ahead_m && foot_point.beyond_m <= 0.0;
       distance_m += kPredictionStepM) {
    const double commanded = curvature_command(p, foot_point);
    const double profile = std::max(segment().at(foot_point.s_m).speed_mps, config_.creep_speed_mps);
    const double speed_mps = std::min(profile, speed_while_steering(curvature, commanded));
    curvature = move_towards(curvature, commanded, config_.path.max_curvature_rate * kPredictionStepM / speed_mps);
    p = propagate(p, kPredictionStepM, curvature, side_slip_rad_);
    foot_point =
        segment().project(point_of(p), foot_point.s_m - kPredictionStepM, foot_point.s_m + 3.0 * kPredictionStepM);
    largest_m = std::max(largest_m, std::abs(segment().cross_track_m(point_of(p), foot_point.s_m)));
  }
  return largest_m;
}

}  // namespace rover::control
