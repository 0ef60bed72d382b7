#include "launcher/progress.hpp"

#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>

namespace rover {
namespace {

constexpr std::array kStateNames = {"BOOT",   "STANDBY",      "DRIVING",    "HAZARD_STOP", "REPAIRING", "SWEEPING",
                                    "CORRECTING", "PAUSED", "GOAL_REACHED", "FAULT_STOP",  "SAFE",      "TELEOP"};
constexpr double kTopSpeed = 0.2;

}  // namespace

std::string state_name(std::int8_t state) {
  const auto index = static_cast<size_t>(state);
  return index < kStateNames.size() ? kStateNames[index] : "?";
}

std::string level_name(std::int8_t level) { return level == supervisor_state_t::FULL ? "FULL" : "EFFICIENT"; }

Progress::Progress(lcm::LCM& lcm, bool enabled) : enabled_(enabled), terminal_(isatty(STDOUT_FILENO) == 1) {
  state_.state = -1;
  lcm.subscribe("POSE", &Progress::on_pose, this);
  lcm.subscribe("PLANNER_STATUS", &Progress::on_planner, this);
  lcm.subscribe("STATE", &Progress::on_state, this);
}

void Progress::on_pose(const lcm::ReceiveBuffer*, const std::string&, const pose_t* message) {
  pose_ = *message;
  if (first_utime_ < 0) {
    first_utime_ = pose_.header.utime;
    started_ = Clock::now();
  }
}

void Progress::on_planner(const lcm::ReceiveBuffer*, const std::string&, const planner_status_t* message) {
  planner_ = *message;
}

void Progress::on_state(const lcm::ReceiveBuffer*, const std::string&, const supervisor_state_t* message) {
  state_ = *message;
}

std::string Progress::line() const {
  const double sim_s = static_cast<double>(pose_.header.utime - first_utime_) * 1e-6;
  const double wall_s = std::chrono::duration<double>(Clock::now() - started_).count();
  const double factor = wall_s > 0.1 ? sim_s / wall_s : 0.0;
  const double speed = std::hypot(pose_.velocity_body_mps[0], pose_.velocity_body_mps[1]);
  char expected[32] = "     -";
  if (factor > 0.0 && std::isfinite(planner_.goal_distance_m) && pose_.travelled_m > 1.0) {
    const double mean_speed = std::min(kTopSpeed, pose_.travelled_m / sim_s);
    std::snprintf(expected, sizeof expected, "%5.0f s", planner_.goal_distance_m / mean_speed / factor);
  }
  char text[256];
  std::snprintf(text, sizeof text,
                "%7.1f m driven  %6.1f m to go  %5.2f m/s  %-12s %-9s  %2d repairs  %2d hazard stops  %4.1fx  end in %s",
                pose_.travelled_m, planner_.goal_distance_m, speed, state_name(state_.state).c_str(),
                level_name(state_.level).c_str(), planner_.replans, state_.hazard_stops, factor, expected);
  return text;
}

void Progress::show() {
  if (!enabled_ || first_utime_ < 0) return;
  const auto period = terminal_ ? std::chrono::milliseconds(250) : std::chrono::milliseconds(10'000);
  const bool changed = state_.state != shown_state_;
  if (!changed && Clock::now() - shown_ < period) return;
  shown_ = Clock::now();
  shown_state_ = state_.state;
  std::printf(terminal_ ? "\r\033[K%s" : "%s\n", line().c_str());
  std::fflush(stdout);
}

void Progress::finish() {
  if (enabled_ && terminal_ && first_utime_ >= 0) std::printf("\n");
}

}  // namespace rover
