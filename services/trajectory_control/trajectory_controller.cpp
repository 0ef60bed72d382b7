#include "trajectory_control/trajectory_controller.hpp"

#include <algorithm>
#include <cmath>

namespace rover::control {
namespace {

constexpr double kMaxStepS = 0.1;
constexpr double kSearchBackM = 0.3;
constexpr double kSearchAheadM = 0.5;
constexpr double kPredictionStepM = 0.1;
constexpr double kSlipSpeedMps = 0.03;  // slower, the direction of the motion is noise
constexpr double kMaxSideSlipRad = 0.35;
constexpr double kStandingMps = 0.02;
constexpr double kSlowMps = 0.1;  // at rest within 5 cm
constexpr double kStandingShare = 0.8;
constexpr double kLeastTurnRad = 0.175;  // 10 deg: below it, it is not the heading that leads out of the corridor

Pose2 moved(const Pose2& pose, double way_m, double curvature_per_m, double side_slip_rad) {
  const double middle = pose.yaw_rad + 0.5 * way_m * curvature_per_m;
  return {pose.x_m + way_m * std::cos(middle + side_slip_rad), pose.y_m + way_m * std::sin(middle + side_slip_rad),
          pose.yaw_rad + way_m * curvature_per_m};
}

Eigen::Vector2d position(const Pose2& pose) {
  return {pose.x_m, pose.y_m};
}

// A rover that drives backwards is one that drives ahead with bow and stern exchanged.
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
  if (path_ && input.id == input_.id && input.backwards == input_.backwards && input.points == input_.points)
    return true;
  input_ = input;
  path_ = TrackedPath::build(input, config_.path);
  set_direction(input.backwards);
  relocate_ = true;
  return path_.has_value();
}

void TrajectoryController::set_direction(bool backwards) {
  if (backwards == backwards_) return;
  backwards_ = backwards;
  curvature_per_m_ = -curvature_per_m_;
  integral_per_m_ = -integral_per_m_;
  side_slip_rad_ = -side_slip_rad_;
}

ControlOutput TrajectoryController::step(Utime now, const PoseInput& pose, const DrivePermit& permit) {
  if (!backwards_) return step_ahead(now, pose, permit);
  ControlOutput out = step_ahead(now, reversed(pose), permit);
  out.command.speed_mps = -out.command.speed_mps;
  out.command.curvature_per_m = -out.command.curvature_per_m;
  return out;
}

ControlOutput TrajectoryController::step_ahead(Utime now, const PoseInput& pose, const DrivePermit& permit) {
  const double dt_s = last_step_ == kNever ? 0.0 : std::min(to_seconds(now - last_step_), kMaxStepS);
  last_step_ = now;
  ControlOutput out;
  out.command.utime = now;
  out.command.valid_until = now;  // no command, unless all is well
  if (path_) {
    out.path_id = path_->id();
    out.corridor_half_width_m = path_->corridor_half_width_m();
  }
  if (!is_fresh(pose, now)) {
    out.state = ControlState::kStalePose;
    return out;
  }
  update_side_slip(pose, dt_s);
  if (!path_) return out;

  const Projection here = advance_on_path(pose.odom);
  out.arc_length_m = leg().start_m() + here.s_m;
  out.remaining_m = path_->length_m() - out.arc_length_m - std::max(here.beyond_m, 0.0);
  out.cross_track_m = leg().cross_track_m(position(pose.odom), here.s_m);
  out.heading_error_rad = wrap_angle(pose.odom.yaw_rad - here.yaw_rad);
  out.predicted_corridor_error_m = predict_corridor_error(pose.odom, here);
  if (std::abs(out.cross_track_m) > path_->corridor_half_width_m()) {
    out.state = ControlState::kOutOfCorridor;
    return out;
  }
  const Utime valid_until = now + to_utime(config_.command_validity_s);
  if (on_last_leg() && out.remaining_m <= config_.end_tolerance_m) {
    out.state = ControlState::kPathEnd;
    out.command.valid_until = valid_until;
    return out;
  }
  if (!permit_valid(permit, now, to_utime(config_.permit_max_age_s))) {
    out.state = ControlState::kNoPermit;
    return out;
  }
  out.command.valid_until = valid_until;
  if (update_turning(out, pose.forward_mps)) {
    out.state = ControlState::kPointTurn;
    turn(out.heading_error_rad, out.command);
  } else {
    out.state = ControlState::kFollowing;
    follow(pose, here, dt_s, permit.max_speed_mps, out.command);
  }
  return out;
}

bool TrajectoryController::is_fresh(const PoseInput& pose, Utime now) const {
  return pose.usable && pose.utime >= 0 && pose.utime <= now && now - pose.utime <= to_utime(config_.pose_max_age_s) &&
         std::isfinite(pose.odom.x_m) && std::isfinite(pose.odom.y_m) && std::isfinite(pose.odom.yaw_rad) &&
         std::isfinite(pose.forward_mps) && std::isfinite(pose.left_mps);
}

Projection TrajectoryController::advance_on_path(const Pose2& pose) {
  if (relocate_) place_ = path_->locate(pose);
  relocate_ = false;
  Projection here = leg().project(position(pose), place_.s_m - kSearchBackM, place_.s_m + kSearchAheadM);
  const double left_on_leg = leg().length_m() - here.s_m - std::max(here.beyond_m, 0.0);
  if (!on_last_leg() && left_on_leg <= config_.end_tolerance_m) {
    ++place_.leg;
    turning_ = true;
    here = leg().project(position(pose), 0.0, kSearchAheadM);
  }
  place_.s_m = here.s_m;
  return here;
}

// A rover that stands or comes to rest and would leave a narrow corridor on its first arc turns on the spot, too: the
// supervisor would stop it. One that stands does so with something in hand, for what the first metre adds.
bool TrajectoryController::update_turning(const ControlOutput& out, double forward_mps) {
  const double speed = std::abs(forward_mps);
  const double share = speed < kStandingMps ? kStandingShare : 1.0;
  const bool would_leave = speed < kSlowMps && out.predicted_corridor_error_m > share * out.corridor_half_width_m;
  const double start_rad = would_leave ? kLeastTurnRad : config_.turn_start_rad;
  turning_ = std::abs(out.heading_error_rad) > (turning_ ? config_.turn_stop_rad : start_rad);
  return turning_;
}

void TrajectoryController::turn(double heading_error_rad, MotionCommand& command) const {
  const double rate = std::min(config_.max_turn_rate_radps,
                               std::sqrt(2.0 * config_.turn_deceleration_radps2 * std::abs(heading_error_rad)));
  command.mode = MotionMode::kPointTurn;
  command.turn_rate_radps = -std::copysign(rate, heading_error_rad);
}

void TrajectoryController::follow(const PoseInput& pose, const Projection& here, double dt_s, double max_speed_mps,
                                  MotionCommand& command) {
  const double speed = std::clamp(pose.forward_mps, 0.0, config_.path.cruise_speed_mps);
  const double ahead_m = speed * config_.response_delay_s;
  const Pose2 soon = moved(pose.odom, ahead_m, curvature_per_m_, side_slip_rad_);
  const Projection there = leg().project(position(soon), here.s_m - kSearchBackM, here.s_m + kSearchAheadM);
  command.mode = MotionMode::kArc;
  command.curvature_per_m = curvature_at(soon, there);
  const double profile = std::max(leg().at(there.s_m).speed_mps, config_.creep_speed_mps);
  command.speed_mps =
      std::min({profile, max_speed_mps, speed_while_steering(curvature_per_m_, command.curvature_per_m)});

  curvature_per_m_ = move_towards(curvature_per_m_, command.curvature_per_m, config_.path.max_curvature_rate * dt_s);
  integrate(here.cross_track_m, speed * dt_s);
}

// The steering is slow: while it turns the rover passes only a little way.
double TrajectoryController::speed_while_steering(double curvature_per_m, double wanted_per_m) const {
  const double left = std::abs(wanted_per_m - curvature_per_m) / config_.path.max_curvature_rate;
  return std::max(config_.steering_way_m / std::max(left, 1e-3), config_.creep_speed_mps);
}

// Only small errors count, so that the way back to the path from afar leaves no overshoot behind.
void TrajectoryController::integrate(double cross_track_m, double way_m) {
  const SteeringLawConfig& c = config_.steering;
  const double counted = std::clamp(cross_track_m, -c.max_integrated_m, c.max_integrated_m);
  integral_per_m_ += c.integral_per_m3 * counted * way_m;
  integral_per_m_ = std::clamp(integral_per_m_, -c.max_integral_per_m, c.max_integral_per_m);
}

// What has to come into line with the path is the direction of the motion: on a slope the rover drives a little
// sideways.
double TrajectoryController::curvature_at(const Pose2& pose, const Projection& place) const {
  const TrackError error{place.cross_track_m, wrap_angle(pose.yaw_rad + side_slip_rad_ - place.yaw_rad)};
  return curvature_to(config_.steering, leg().at(place.s_m).curvature_per_m, error, integral_per_m_);
}

void TrajectoryController::update_side_slip(const PoseInput& pose, double dt_s) {
  if (pose.forward_mps < kSlipSpeedMps) return;
  const double measured = std::clamp(std::atan2(pose.left_mps, pose.forward_mps), -kMaxSideSlipRad, kMaxSideSlipRad);
  side_slip_rad_ += (measured - side_slip_rad_) * std::min(1.0, dt_s / config_.side_slip_time_s);
}

// Runs the control law ahead on a model of the rover: arcs, the steering's rate, the measured side slip.
double TrajectoryController::predict_corridor_error(const Pose2& pose, const Projection& here) const {
  Pose2 p = pose;
  Projection place = here;
  double curvature = curvature_per_m_;
  double largest = std::abs(leg().cross_track_m(position(p), here.s_m));
  // A point turn comes first and moves nothing.
  if (turning_ || std::abs(wrap_angle(pose.yaw_rad - here.yaw_rad)) > config_.turn_start_rad) return largest;
  for (double way = 0.0; way < config_.look_ahead_m && place.beyond_m <= 0.0; way += kPredictionStepM) {
    const double wanted = curvature_at(p, place);
    const double profile = std::max(leg().at(place.s_m).speed_mps, config_.creep_speed_mps);
    const double speed = std::min(profile, speed_while_steering(curvature, wanted));
    curvature = move_towards(curvature, wanted, config_.path.max_curvature_rate * kPredictionStepM / speed);
    p = moved(p, kPredictionStepM, curvature, side_slip_rad_);
    place = leg().project(position(p), place.s_m - kPredictionStepM, place.s_m + 3.0 * kPredictionStepM);
    largest = std::max(largest, std::abs(leg().cross_track_m(position(p), place.s_m)));
  }
  return largest;
}

}  // namespace rover::control
