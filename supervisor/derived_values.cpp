#include "supervisor/derived_values.hpp"

#include <algorithm>
#include <cmath>

namespace rover::supervisor {
namespace {

double duration_s(bool condition, Utime now, Utime& since) {
  if (!condition) since = kNever;
  if (condition && since == kNever) since = now;
  return since == kNever ? 0.0 : to_seconds(now - since);
}

}  // namespace

DerivedValueTracker::DerivedValueTracker(const DerivedValueConfig& config)
    : config_(config),
      drive_thermal_(6, MotorThermalModel(config.drive_nominal_a, config.motor_thermal_time_s)),
      steer_thermal_(4, MotorThermalModel(config.steer_nominal_a, config.motor_thermal_time_s)) {}

void DerivedValueTracker::on_wheels(const WheelReport& wheels) {
  heat_.utime = wheels.utime;
  for (size_t i = 0; i < drive_thermal_.size(); ++i) drive_thermal_[i].add(wheels.drive_current_a[i], wheels.utime);
  for (size_t i = 0; i < steer_thermal_.size(); ++i) steer_thermal_[i].add(wheels.steer_current_a[i], wheels.utime);
  set_loads();
}

void DerivedValueTracker::set_loads() {
  for (size_t i = 0; i < drive_thermal_.size(); ++i) heat_.drive_i2t_load[i] = drive_thermal_[i].load();
  for (size_t i = 0; i < steer_thermal_.size(); ++i) heat_.steer_i2t_load[i] = steer_thermal_[i].load();
  derived_.drive_i2t_load = heat_.drive_i2t_load;
  derived_.steer_i2t_load = heat_.steer_i2t_load;
}

void DerivedValueTracker::restore(const MotorHeat& heat, const EventCounters& counters) {
  heat_.utime = heat.utime;
  for (size_t i = 0; i < drive_thermal_.size(); ++i) drive_thermal_[i].restore(heat.drive_i2t_load[i], heat.utime);
  for (size_t i = 0; i < steer_thermal_.size(); ++i) steer_thermal_[i].restore(heat.steer_i2t_load[i], heat.utime);
  set_loads();
  counters_ = counters;
}

void DerivedValueTracker::on_service(const std::string& name, const ServiceReport& before, const ServiceReport& now) {
  newest_report_ = std::max(newest_report_, now.utime);
  if (before.boot_id > 0 && now.boot_id > before.boot_id) counters_.starts[name].push_back(now.utime);
  // Counters of a new process start at zero.
  const bool same_process = before.utime >= 0 && now.boot_id == before.boot_id;
  if (same_process) losses_.push_back({now.utime, now.received - before.received, now.lost - before.lost});
}

void DerivedValueTracker::step(Utime now, const Inputs& inputs, bool permitted) {
  derived_.clock_step_s = last_tick_ == kNever ? 0.0 : std::abs(to_seconds(now - last_tick_ - kTickUs));
  last_tick_ = now;
  step_losses(now);
  step_starts(now);
  step_motion(now, inputs, permitted);
  if (std::isfinite(inputs.pose.travelled_m)) travelled_m_ = inputs.pose.travelled_m;
  step_fault_stops();
}

void DerivedValueTracker::reset_counters() {
  counters_ = {};
  derived_.starts.clear();
  step_fault_stops();
}

void DerivedValueTracker::step_fault_stops() {
  std::erase_if(counters_.fault_stops_m,
                [&](double at_m) { return travelled_m_ - at_m > config_.fault_stop_distance_m; });
  derived_.fault_stops = static_cast<double>(counters_.fault_stops_m.size());
}

void DerivedValueTracker::step_losses(Utime now) {
  while (!losses_.empty() && now - losses_.front().utime > to_utime(config_.loss_window_s)) losses_.pop_front();
  double received = 0.0, lost = 0.0;
  for (const Loss& loss : losses_) {
    received += static_cast<double>(loss.received);
    lost += static_cast<double>(loss.lost);
  }
  derived_.loss_ratio = lost > 0.0 ? lost / (received + lost) : 0.0;
  derived_.lost_utime = newest_report_;
}

void DerivedValueTracker::step_starts(Utime now) {
  derived_.starts.clear();
  for (auto& [name, starts] : counters_.starts) {
    while (!starts.empty() && now - starts.front() > to_utime(config_.start_window_s)) starts.pop_front();
    derived_.starts[name] = static_cast<int>(starts.size());
  }
}

void DerivedValueTracker::step_motion(Utime now, const Inputs& inputs, bool permitted) {
  const bool wheels_turning =
      std::any_of(inputs.wheels.drive_rate_radps.begin(), inputs.wheels.drive_rate_radps.end(),
                  [&](double rate) { return std::abs(rate) * config_.wheel_radius_m > config_.stationary_wheel_mps; });
  // Up to the newest report: silent wheels are not moving wheels.
  derived_.unpermitted_s = duration_s(!permitted && wheels_turning, inputs.wheels.utime, moving_since_);
  derived_.idle_s = duration_s(permitted && !wheels_turning, now, idle_since_);
}

}  // namespace rover::supervisor
