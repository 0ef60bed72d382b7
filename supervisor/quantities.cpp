#include "supervisor/quantities.hpp"

#include <algorithm>
#include <cmath>

namespace rover::supervisor {
namespace {

// The prediction is pessimistic in tight repairs, so it counts only if the cross track exceeds this fraction
// of the corridor half width.
constexpr double kPredictionMinFraction = 0.4;

template <auto Report>
Reading age(const MonitorContext& context, const Subject&, double limit) {
  return age_reading((context.inputs.*Report).utime, context.utime, limit);
}

Reading vo_age(const MonitorContext& context, const Subject&, double limit) {
  return age_reading(context.inputs.pose.vo_utime, context.utime, limit);
}

Reading motion_command_age(const MonitorContext& context, const Subject&, double limit) {
  return age_reading(context.inputs.motion_command_utime, context.utime, limit);
}

Reading pose_lost(const MonitorContext& context, const Subject&, double) {
  return flag_reading(!context.inputs.pose.usable, context.inputs.pose.utime, context.utime);
}

template <auto Value>
Reading pose_above(const MonitorContext& context, const Subject&, double limit) {
  return above_reading(std::abs(context.inputs.pose.*Value), limit, context.inputs.pose.utime, context.utime);
}

template <auto Value>
Reading pose_above_deg(const MonitorContext& context, const Subject&, double limit) {
  return above_reading(to_deg(std::abs(context.inputs.pose.*Value)), limit, context.inputs.pose.utime, context.utime);
}

Reading blind_frames(const MonitorContext& context, const Subject&, double limit) {
  return above_reading(context.inputs.consecutive_blind_frames, limit, context.inputs.hazards.utime, context.utime);
}

Reading loccam_age(const MonitorContext& context, const Subject&, double limit) {
  return age_reading(context.inputs.seen_utime, context.utime, limit);
}

Reading loccam_displaced(const MonitorContext& context, const Subject&, double) {
  return flag_reading(context.inputs.visual.displaced, context.inputs.visual.utime, context.utime);
}

Reading stereo_coverage(const MonitorContext& context, const Subject&, double limit) {
  return below_reading(context.inputs.hazards.coverage, limit, context.inputs.hazards.utime, context.utime);
}

// Maps are published per distance, so their age is the distance driven since. During a sweep a new map is due.
Reading terrain_distance(const MonitorContext& context, const Subject&, double limit) {
  if (context.sweep_s > 0.0) return flag_reading(false, context.utime, context.utime);
  if (context.inputs.terrain.utime < 0) return age_reading(kNever, context.utime, limit);
  const double distance_m = std::abs(context.inputs.pose.travelled_m - context.inputs.terrain.travelled_m);
  return above_reading(distance_m, limit, context.inputs.pose.utime, context.utime);
}

Reading sweep_time(const MonitorContext& context, const Subject&, double limit) {
  return above_reading(context.sweep_s, limit, context.utime, context.utime);
}

Reading slam_lost(const MonitorContext& context, const Subject&, double) {
  return flag_reading(context.inputs.slam.lost, context.inputs.slam.utime, context.utime);
}

Reading corridor_deviation(const MonitorContext& context, const Subject&, double) {
  const ControlReport& control = context.inputs.control;
  Reading out = flag_reading(control.out_of_corridor, control.utime, context.utime);
  out.value = control.cross_track_m;
  out.limit = control.corridor_half_width_m;
  return out;
}

Reading predicted_corridor_ratio(const MonitorContext& context, const Subject&, double limit) {
  const ControlReport& control = context.inputs.control;
  if (control.stale_pose || !(control.corridor_half_width_m > 0.0))
    return flag_reading(false, control.utime, context.utime);
  const double predicted = control.predicted_error_m / control.corridor_half_width_m;
  const bool deviates = std::abs(control.cross_track_m) > kPredictionMinFraction * control.corridor_half_width_m;
  Reading out = above_reading(predicted, limit, control.utime, context.utime);
  if (!deviates && out.condition == Condition::kTrue) out.condition = Condition::kFalse;
  return out;
}

// A planner without a path is covered by no_path.
Reading path_mismatch(const MonitorContext& context, const Subject&, double) {
  const bool mismatch =
      context.inputs.planner.path_id >= 0 && context.inputs.control.path_id != context.inputs.planner.path_id;
  Reading out = flag_reading(mismatch, context.inputs.control.utime, context.utime);
  out.value = static_cast<double>(context.inputs.control.path_id);
  out.limit = static_cast<double>(context.inputs.planner.path_id);
  return out;
}

Reading no_path(const MonitorContext& context, const Subject&, double) {
  const bool none = context.inputs.planner.state == PlannerState::kNoPath && context.stationary;
  return flag_reading(none, context.inputs.planner.utime, context.utime);
}

Reading keep_out_depth(const MonitorContext& context, const Subject&, double limit) {
  return above_reading(context.keep_out_depth_m, limit, context.inputs.pose.utime, context.utime);
}

Reading blocked(const MonitorContext& context, const Subject&, double) {
  const bool waiting = context.waiting_for_path && context.stationary;
  Reading out = flag_reading(waiting, context.inputs.planner.utime, context.utime);
  out.value = context.inputs.planner.blocked_in_m;
  out.limit = context.stop_distance_m;
  return out;
}

// Slip is undefined at rest (valid == 0); that is not a fault.
Reading slip_ratio(const MonitorContext& context, const Subject&, double limit) {
  if (!context.inputs.slip.valid) return flag_reading(false, context.inputs.slip.utime, context.utime);
  return above_reading(context.inputs.slip.ratio, limit, context.inputs.slip.utime, context.utime);
}

template <auto Values>
Reading motor_above(const MonitorContext& context, const Subject& motor, double limit) {
  const double current = (context.inputs.wheels.*Values)[static_cast<size_t>(motor.index)];
  return above_reading(std::abs(current), limit, context.inputs.wheels.utime, context.utime);
}

template <auto Values>
Reading i2t_load_above(const MonitorContext& context, const Subject& motor, double limit) {
  const double load = (context.derived.*Values)[static_cast<size_t>(motor.index)];
  return above_reading(load, limit, context.inputs.wheels.utime, context.utime);
}

Reading wheel_fault(const MonitorContext& context, const Subject&, double) {
  return flag_reading(context.inputs.wheels.fault, context.inputs.wheels.utime, context.utime);
}

Reading imu_fault(const MonitorContext& context, const Subject&, double) {
  return flag_reading(context.inputs.imu.fault, context.inputs.imu.utime, context.utime);
}

const ServiceReport& service(const MonitorContext& context, const Subject& subject) {
  static const ServiceReport kNone;
  const auto it = context.inputs.services.find(subject.service);
  return it == context.inputs.services.end() ? kNone : it->second;
}

Reading heartbeat_age(const MonitorContext& context, const Subject& subject, double limit) {
  return age_reading(service(context, subject).utime, context.utime, limit);
}

// An optional service that never sent a heartbeat is not installed.
Reading optional_heartbeat_age(const MonitorContext& context, const Subject& subject, double limit) {
  const ServiceReport& report = service(context, subject);
  return report.utime < 0 ? flag_reading(false, context.utime, context.utime)
                          : age_reading(report.utime, context.utime, limit);
}

// A service that was started on demand is given as long for its first heartbeat as for the next.
Reading full_missing(const MonitorContext& context, const Subject& subject, double limit) {
  const bool silent = age_reading(service(context, subject).utime, context.utime, limit).condition != Condition::kFalse;
  return above_reading(silent ? context.full_missing_s : 0.0, limit, context.utime, context.utime);
}

template <ServiceStatus From>
Reading service_status(const MonitorContext& context, const Subject& subject, double) {
  const ServiceReport& report = service(context, subject);
  Reading out = flag_reading(report.status >= From, report.utime, context.utime);
  out.value = static_cast<double>(report.status);
  return out;
}

// The recorder reports DEGRADED if it cannot write its log; the rover continues.
Reading log_lost(const MonitorContext& context, const Subject&, double limit) {
  return service_status<ServiceStatus::kDegraded>(context, {"recorder", 0}, limit);
}

Reading service_starts(const MonitorContext& context, const Subject& subject, double limit) {
  const auto it = context.derived.starts.find(subject.service);
  return above_reading(it == context.derived.starts.end() ? 0 : it->second, limit, context.utime, context.utime);
}

Reading restart_attempts(const MonitorContext& context, const Subject& subject, double limit) {
  const auto it = context.derived.restart_attempts.find(subject.service);
  return above_reading(it == context.derived.restart_attempts.end() ? 0 : it->second, limit, context.utime,
                       context.utime);
}

Reading message_loss_ratio(const MonitorContext& context, const Subject&, double limit) {
  return above_reading(context.derived.loss_ratio, limit, context.derived.lost_utime, context.utime);
}

template <auto Value>
Reading derived_above(const MonitorContext& context, const Subject&, double limit) {
  return above_reading(context.derived.*Value, limit, context.utime, context.utime);
}

using enum Expansion;
using P = PoseReport;
constexpr bool kOfComputing = true;

constexpr std::array kQuantities = {
    Quantity{"slip_ratio", kOne, slip_ratio},
    Quantity{"predicted_corridor_ratio", kOne, predicted_corridor_ratio},
    Quantity{"corridor_deviation", kOne, corridor_deviation},
    Quantity{"roll_deg", kOne, pose_above_deg<&P::roll_rad>},
    Quantity{"pitch_deg", kOne, pose_above_deg<&P::pitch_rad>},
    Quantity{"tilt_rate_degps", kOne, pose_above_deg<&P::tilt_rate_radps>},
    Quantity{"drive_current_a", kEachDrive, motor_above<&WheelReport::drive_current_a>},
    Quantity{"drive_i2t_load", kEachDrive, i2t_load_above<&DerivedValues::drive_i2t_load>},
    Quantity{"steer_current_a", kEachSteer, motor_above<&WheelReport::steer_current_a>},
    Quantity{"steer_i2t_load", kEachSteer, i2t_load_above<&DerivedValues::steer_i2t_load>},
    Quantity{"wheel_state_age_s", kOne, age<&Inputs::wheels>},
    Quantity{"wheel_fault", kOne, wheel_fault},
    Quantity{"imu_age_s", kOne, age<&Inputs::imu>},
    Quantity{"imu_fault", kOne, imu_fault},
    Quantity{"pose_age_s", kOne, age<&Inputs::pose>},
    Quantity{"pose_lost", kOne, pose_lost},
    Quantity{"pose_sigma_m", kOne, pose_above<&P::sigma_m>},
    Quantity{"vo_age_s", kOne, vo_age, kOfComputing},
    Quantity{"hazards_age_s", kOne, age<&Inputs::hazards>, kOfComputing},
    Quantity{"blind_frames", kOne, blind_frames},
    Quantity{"loccam_age_s", kOne, loccam_age, kOfComputing},
    Quantity{"loccam_displaced", kOne, loccam_displaced},
    Quantity{"stereo_coverage", kOne, stereo_coverage},
    Quantity{"planner_age_s", kOne, age<&Inputs::planner>},
    Quantity{"control_age_s", kOne, age<&Inputs::control>},
    Quantity{"motion_command_age_s", kOne, motion_command_age},
    Quantity{"terrain_distance_m", kOne, terrain_distance},
    Quantity{"sweep_s", kOne, sweep_time},
    Quantity{"slam_lost", kOne, slam_lost},
    Quantity{"path_mismatch", kOne, path_mismatch},
    Quantity{"no_path", kOne, no_path},
    Quantity{"blocked", kOne, blocked},
    Quantity{"keep_out_depth_m", kOne, keep_out_depth},
    Quantity{"heartbeat_age_s", kEachRequired, heartbeat_age, kOfComputing},
    Quantity{"optional_heartbeat_age_s", kEachOptional, optional_heartbeat_age, kOfComputing},
    Quantity{"service_fault", kEachRequired, service_status<ServiceStatus::kFault>},
    Quantity{"log_lost", kOne, log_lost},
    Quantity{"starts_per_minute", kEachRequired, service_starts},
    Quantity{"restart_attempts", kEachRequired, restart_attempts},
    Quantity{"full_heartbeat_age_s", kEachFull, heartbeat_age, kOfComputing},
    Quantity{"full_idle_heartbeat_age_s", kEachFull, optional_heartbeat_age, kOfComputing},
    Quantity{"full_missing_s", kEachFull, full_missing, kOfComputing},
    Quantity{"full_service_fault", kEachFull, service_status<ServiceStatus::kFault>},
    Quantity{"full_starts_per_minute", kEachFull, service_starts},
    Quantity{"full_restart_attempts", kEachFull, restart_attempts},
    Quantity{"message_loss_ratio", kOne, message_loss_ratio},
    Quantity{"clock_step_s", kOne, derived_above<&DerivedValues::clock_step_s>},
    Quantity{"unpermitted_motion_s", kOne, derived_above<&DerivedValues::unpermitted_s>},
    Quantity{"idle_drive_s", kOne, derived_above<&DerivedValues::idle_s>},
    Quantity{"fault_stops", kOne, derived_above<&DerivedValues::fault_stops>},
};

}  // namespace

std::span<const Quantity> quantities() {
  return kQuantities;
}

const Quantity* find_quantity(const std::string& name) {
  const auto it =
      std::find_if(kQuantities.begin(), kQuantities.end(), [&](const Quantity& q) { return q.name == name; });
  return it == kQuantities.end() ? nullptr : &*it;
}

}  // namespace rover::supervisor
