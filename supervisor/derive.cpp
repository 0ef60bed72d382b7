#include "supervisor/derive.hpp"

#include <algorithm>
#include <cmath>

namespace rover::supervisor {
namespace {

double lasting_s(bool is_so, Utime now, Utime& since) {
  if (!is_so) since = kNever;
  if (is_so && since == kNever) since = now;
  return since == kNever ? 0.0 : to_seconds(now - since);
}

}  // namespace

Derive::Derive(const DeriveConfig& config)
    : config_(config),
      drive_heat_(6, MotorHeat(config.drive_nominal_a, config.motor_time_s)),
      steer_heat_(4, MotorHeat(config.steer_nominal_a, config.motor_time_s)) {}

void Derive::on_wheels(const WheelReport& wheels) {
  for (size_t i = 0; i < drive_heat_.size(); ++i) {
    drive_heat_[i].add(wheels.drive_a[i], wheels.utime);
    derived_.drive_heat[i] = drive_heat_[i].load();
  }
  for (size_t i = 0; i < steer_heat_.size(); ++i) {
    steer_heat_[i].add(wheels.steer_a[i], wheels.utime);
    derived_.steer_heat[i] = steer_heat_[i].load();
  }
}

void Derive::on_service(const std::string& name, const ServiceReport& before, const ServiceReport& now) {
  newest_ = std::max(newest_, now.utime);
  if (before.boot_id > 0 && now.boot_id > before.boot_id) starts_[name].push_back(now.utime);
  // A new process counts from zero.
  const bool same = before.utime >= 0 && now.boot_id == before.boot_id;
  if (same) losses_.push_back({now.utime, now.received - before.received, now.lost - before.lost});
}

void Derive::step(Utime now, const Inputs& in, bool permitted) {
  derived_.clock_step_s = last_tick_ == kNever ? 0.0 : std::abs(to_seconds(now - last_tick_ - kTickUs));
  last_tick_ = now;
  step_losses(now);
  step_starts(now);
  step_motion(now, in, permitted);
  step_fault_stops(in);
}

void Derive::forget_counts(const Inputs& in) {
  starts_.clear();
  derived_.starts.clear();
  fault_stops_.clear();
  step_fault_stops(in);
}

void Derive::step_fault_stops(const Inputs& in) {
  std::erase_if(fault_stops_, [&](double at_m) { return in.pose.travelled_m - at_m > config_.fault_stop_way_m; });
  derived_.fault_stops = static_cast<double>(fault_stops_.size());
}

void Derive::step_losses(Utime now) {
  while (!losses_.empty() && now - losses_.front().utime > to_utime(config_.loss_window_s)) losses_.pop_front();
  double received = 0.0, lost = 0.0;
  for (const Loss& loss : losses_) {
    received += static_cast<double>(loss.received);
    lost += static_cast<double>(loss.lost);
  }
  derived_.lost_share = lost > 0.0 ? lost / (received + lost) : 0.0;
  derived_.lost_utime = newest_;
}

void Derive::step_starts(Utime now) {
  derived_.starts.clear();
  for (auto& [name, starts] : starts_) {
    while (!starts.empty() && now - starts.front() > to_utime(config_.start_window_s)) starts.pop_front();
    derived_.starts[name] = static_cast<int>(starts.size());
  }
}

void Derive::step_motion(Utime now, const Inputs& in, bool permitted) {
  const bool turning = std::any_of(in.wheels.drive_radps.begin(), in.wheels.drive_radps.end(), [&](double rate) {
    return std::abs(rate) * config_.wheel_radius_m > config_.standing_wheel_mps;
  });
  derived_.unpermitted_s = lasting_s(!permitted && turning, now, moving_since_);
  derived_.idle_s = lasting_s(permitted && !turning, now, idle_since_);
}

}  // namespace rover::supervisor
