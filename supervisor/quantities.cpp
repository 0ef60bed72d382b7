#include "supervisor/quantities.hpp"

#include <algorithm>
#include <cmath>

namespace rover::supervisor {
namespace {

// The prediction errs to the safe side in tight repairs while the rover is on its path; from this share of the corridor
// on it is believed.
constexpr double kPredictionFrom = 0.4;

template <auto Report>
Reading age(const Now& now, const Subject&, double limit) {
  return age_reading((now.in.*Report).utime, now.utime, limit);
}

Reading vo_age(const Now& now, const Subject&, double limit) {
  return age_reading(now.in.pose.vo_utime, now.utime, limit);
}

Reading motion_command_age(const Now& now, const Subject&, double limit) {
  return age_reading(now.in.motion_command_utime, now.utime, limit);
}

Reading pose_lost(const Now& now, const Subject&, double) {
  return flag_reading(!now.in.pose.usable, now.in.pose.utime, now.utime);
}

template <auto Value>
Reading pose_above(const Now& now, const Subject&, double limit) {
  return above_reading(std::abs(now.in.pose.*Value), limit, now.in.pose.utime, now.utime);
}

template <auto Value>
Reading pose_above_deg(const Now& now, const Subject&, double limit) {
  return above_reading(to_deg(std::abs(now.in.pose.*Value)), limit, now.in.pose.utime, now.utime);
}

Reading blind_frames(const Now& now, const Subject&, double limit) {
  return above_reading(now.in.blind_in_a_row, limit, now.in.hazards.utime, now.utime);
}

Reading stereo_coverage(const Now& now, const Subject&, double limit) {
  return below_reading(now.in.hazards.coverage, limit, now.in.hazards.utime, now.utime);
}

// The map comes with the way, not with time: what ages it is ground that was driven since. A rover that sweeps is about
// to have a new one.
Reading terrain_way(const Now& now, const Subject&, double limit) {
  if (now.sweep_s > 0.0) return flag_reading(false, now.utime, now.utime);
  if (now.in.terrain.utime < 0) return age_reading(kNever, now.utime, limit);
  const double way = std::abs(now.in.pose.travelled_m - now.in.terrain.travelled_m);
  return above_reading(way, limit, now.in.pose.utime, now.utime);
}

Reading sweep_time(const Now& now, const Subject&, double limit) {
  return above_reading(now.sweep_s, limit, now.utime, now.utime);
}

Reading slam_lost(const Now& now, const Subject&, double) {
  return flag_reading(now.in.slam.lost, now.in.slam.utime, now.utime);
}

Reading corridor_deviation(const Now& now, const Subject&, double) {
  const ControlReport& control = now.in.control;
  Reading out = flag_reading(control.out_of_corridor, control.utime, now.utime);
  out.value = control.cross_track_m;
  out.limit = control.corridor_half_width_m;
  return out;
}

Reading predicted_corridor_share(const Now& now, const Subject&, double limit) {
  const ControlReport& control = now.in.control;
  if (control.stale_pose || !(control.corridor_half_width_m > 0.0))
    return flag_reading(false, control.utime, now.utime);
  const double predicted = control.predicted_error_m / control.corridor_half_width_m;
  const bool strays = std::abs(control.cross_track_m) > kPredictionFrom * control.corridor_half_width_m;
  Reading out = above_reading(predicted, limit, control.utime, now.utime);
  if (!strays && out.condition == Condition::kTrue) out.condition = Condition::kFalse;
  return out;
}

// A planner without a path is the concern of no_path.
Reading path_mismatch(const Now& now, const Subject&, double) {
  const bool another = now.in.planner.path_id >= 0 && now.in.control.path_id != now.in.planner.path_id;
  Reading out = flag_reading(another, now.in.control.utime, now.utime);
  out.value = static_cast<double>(now.in.control.path_id);
  out.limit = static_cast<double>(now.in.planner.path_id);
  return out;
}

Reading no_path(const Now& now, const Subject&, double) {
  const bool none = now.in.planner.state == PlannerState::kNoPath && now.standing_still;
  return flag_reading(none, now.in.planner.utime, now.utime);
}

Reading blocked(const Now& now, const Subject&, double) {
  const bool waits = now.waits_before_block && now.blocked_in_m <= now.stop_distance_m;
  Reading out = flag_reading(waits, now.in.planner.utime, now.utime);
  out.value = now.in.planner.blocked_in_m;
  out.limit = now.stop_distance_m;
  return out;
}

// At rest slip is not defined, and says so itself; that is not a fault.
Reading slip_ratio(const Now& now, const Subject&, double limit) {
  if (!now.in.slip.valid) return flag_reading(false, now.in.slip.utime, now.utime);
  return above_reading(now.in.slip.ratio, limit, now.in.slip.utime, now.utime);
}

template <auto Values>
Reading motor_above(const Now& now, const Subject& motor, double limit) {
  const double current = (now.in.wheels.*Values)[static_cast<size_t>(motor.index)];
  return above_reading(std::abs(current), limit, now.in.wheels.utime, now.utime);
}

template <auto Values>
Reading heat_above(const Now& now, const Subject& motor, double limit) {
  const double load = (now.derived.*Values)[static_cast<size_t>(motor.index)];
  return above_reading(load, limit, now.in.wheels.utime, now.utime);
}

Reading wheel_fault(const Now& now, const Subject&, double) {
  return flag_reading(now.in.wheels.fault, now.in.wheels.utime, now.utime);
}

Reading imu_fault(const Now& now, const Subject&, double) {
  return flag_reading(now.in.imu.fault, now.in.imu.utime, now.utime);
}

const ServiceReport& service(const Now& now, const Subject& subject) {
  static const ServiceReport kNone;
  const auto it = now.in.services.find(subject.service);
  return it == now.in.services.end() ? kNone : it->second;
}

Reading heartbeat_age(const Now& now, const Subject& subject, double limit) {
  return age_reading(service(now, subject).utime, now.utime, limit);
}

// A service that nobody has heard yet is not there: on a vehicle without a page, say.
Reading optional_heartbeat_age(const Now& now, const Subject& subject, double limit) {
  const ServiceReport& report = service(now, subject);
  return report.utime < 0 ? flag_reading(false, now.utime, now.utime) : age_reading(report.utime, now.utime, limit);
}

template <ServiceStatus From>
Reading service_status(const Now& now, const Subject& subject, double) {
  const ServiceReport& report = service(now, subject);
  Reading out = flag_reading(report.status >= From, report.utime, now.utime);
  out.value = static_cast<double>(report.status);
  return out;
}

// The recorder says so itself when the disk no longer takes its log; the rover drives on.
Reading log_lost(const Now& now, const Subject&, double limit) {
  return service_status<ServiceStatus::kDegraded>(now, {"recorder", 0}, limit);
}

Reading service_starts(const Now& now, const Subject& subject, double limit) {
  const auto it = now.derived.starts.find(subject.service);
  return above_reading(it == now.derived.starts.end() ? 0 : it->second, limit, now.utime, now.utime);
}

Reading restart_tries(const Now& now, const Subject& subject, double limit) {
  const auto it = now.derived.tries.find(subject.service);
  return above_reading(it == now.derived.tries.end() ? 0 : it->second, limit, now.utime, now.utime);
}

Reading lost_share(const Now& now, const Subject&, double limit) {
  return above_reading(now.derived.lost_share, limit, now.derived.lost_utime, now.utime);
}

template <auto Value>
Reading derived_above(const Now& now, const Subject&, double limit) {
  return above_reading(now.derived.*Value, limit, now.utime, now.utime);
}

using enum Expansion;
using P = PoseReport;

constexpr std::array kQuantities = {
    Quantity{"slip_ratio", kOne, slip_ratio},
    Quantity{"predicted_corridor_share", kOne, predicted_corridor_share},
    Quantity{"corridor_deviation", kOne, corridor_deviation},
    Quantity{"roll_deg", kOne, pose_above_deg<&P::roll_rad>},
    Quantity{"pitch_deg", kOne, pose_above_deg<&P::pitch_rad>},
    Quantity{"tilt_rate_degps", kOne, pose_above_deg<&P::tilt_rate_radps>},
    Quantity{"drive_current_a", kEachDrive, motor_above<&WheelReport::drive_a>},
    Quantity{"drive_i2t_load", kEachDrive, heat_above<&Derived::drive_heat>},
    Quantity{"steer_current_a", kEachSteer, motor_above<&WheelReport::steer_a>},
    Quantity{"steer_i2t_load", kEachSteer, heat_above<&Derived::steer_heat>},
    Quantity{"wheel_state_age_s", kOne, age<&Inputs::wheels>},
    Quantity{"wheel_fault", kOne, wheel_fault},
    Quantity{"imu_age_s", kOne, age<&Inputs::imu>},
    Quantity{"imu_fault", kOne, imu_fault},
    Quantity{"pose_age_s", kOne, age<&Inputs::pose>},
    Quantity{"pose_lost", kOne, pose_lost},
    Quantity{"pose_sigma_m", kOne, pose_above<&P::sigma_m>},
    Quantity{"vo_age_s", kOne, vo_age},
    Quantity{"hazards_age_s", kOne, age<&Inputs::hazards>},
    Quantity{"blind_frames", kOne, blind_frames},
    Quantity{"stereo_coverage", kOne, stereo_coverage},
    Quantity{"planner_age_s", kOne, age<&Inputs::planner>},
    Quantity{"control_age_s", kOne, age<&Inputs::control>},
    Quantity{"motion_command_age_s", kOne, motion_command_age},
    Quantity{"terrain_way_m", kOne, terrain_way},
    Quantity{"sweep_s", kOne, sweep_time},
    Quantity{"slam_lost", kOne, slam_lost},
    Quantity{"path_mismatch", kOne, path_mismatch},
    Quantity{"no_path", kOne, no_path},
    Quantity{"blocked", kOne, blocked},
    Quantity{"heartbeat_age_s", kEachRequired, heartbeat_age},
    Quantity{"optional_heartbeat_age_s", kEachOptional, optional_heartbeat_age},
    Quantity{"service_fault", kEachRequired, service_status<ServiceStatus::kFault>},
    Quantity{"log_lost", kOne, log_lost},
    Quantity{"starts_per_minute", kEachRequired, service_starts},
    Quantity{"restart_tries", kEachRequired, restart_tries},
    Quantity{"full_heartbeat_age_s", kEachFull, heartbeat_age},
    Quantity{"full_idle_heartbeat_age_s", kEachFull, optional_heartbeat_age},
    Quantity{"full_service_fault", kEachFull, service_status<ServiceStatus::kFault>},
    Quantity{"full_starts_per_minute", kEachFull, service_starts},
    Quantity{"full_restart_tries", kEachFull, restart_tries},
    Quantity{"lost_share", kOne, lost_share},
    Quantity{"clock_step_s", kOne, derived_above<&Derived::clock_step_s>},
    Quantity{"unpermitted_motion_s", kOne, derived_above<&Derived::unpermitted_s>},
    Quantity{"idle_drive_s", kOne, derived_above<&Derived::idle_s>},
    Quantity{"fault_stops", kOne, derived_above<&Derived::fault_stops>},
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
