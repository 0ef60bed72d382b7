#include "tools/launcher/progress.hpp"

#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "common/bus/channels.hpp"
#include "common/bus/state_names.hpp"
#include "common/bus/streams.hpp"

namespace rover {
namespace {

constexpr double kTopSpeed = 0.2;

}  // namespace

Progress::Progress(lcm::LCM& lcm) : terminal_(isatty(STDOUT_FILENO) == 1) {
  pose_.header.utime = -1;
  state_.state = -1;
  state_.header.utime = -1;
  listen(lcm, channel::kPose, pose_);
  listen(lcm, channel::kPlannerStatus, planner_);
  listen(lcm, channel::kState, state_);
}

// Undecodable messages are ignored here; the services count and report them.
template <class Message>
void Progress::listen(lcm::LCM& lcm, const char* channel, Message& newest) {
  lcm.subscribeFunction(
      channel,
      +[](const lcm::ReceiveBuffer* buffer, const std::string&, Message* out) {
        Message message;
        if (decode_message(buffer->data, static_cast<int>(buffer->data_size), message)) *out = message;
      },
      &newest);
}

bool Progress::supervisor_hangs() const {
  constexpr std::int64_t kSilence = 2'000'000;  // message time; STATE has 10 Hz
  return state_.header.utime >= 0 && pose_.header.utime - state_.header.utime > kSilence;
}

std::string Progress::line() const {
  // "-" before the first message.
  const auto figure = [](const char* format, double value) {
    char text[16];
    std::snprintf(text, sizeof text, format, value);
    return std::string(std::isfinite(value) ? text : "-");
  };
  const double sim_s = static_cast<double>(pose_.header.utime - first_utime_) * 1e-6;
  const double wall_s = std::chrono::duration<double>(Clock::now() - started_).count();
  const double factor = wall_s > 0.1 ? sim_s / wall_s : 0.0;
  const double speed = std::hypot(pose_.velocity_body_mps[0], pose_.velocity_body_mps[1]);
  std::string expected = "-";
  if (factor > 0.0 && std::isfinite(planner_.goal_distance_m) && pose_.travelled_m > 1.0) {
    const double mean_speed = std::min(kTopSpeed, pose_.travelled_m / sim_s);
    expected = figure("%.0f s", planner_.goal_distance_m / mean_speed / factor);
  }
  char text[256];
  std::snprintf(
      text, sizeof text,
      "%7.1f m driven  %6s m remaining  %5s m/s  %-12s %-9s  %2d repairs  %2d hazard stops  %4.1fx  end in %7s",
      pose_.travelled_m, figure("%.1f", planner_.goal_distance_m).c_str(), figure("%.2f", speed).c_str(),
      state_name(state_.state).c_str(), level_name(state_.level).c_str(), planner_.replans, state_.hazard_stops, factor,
      expected.c_str());
  return text;
}

void Progress::show() {
  if (first_utime_ < 0 && started()) {
    first_utime_ = pose_.header.utime;
    started_ = Clock::now();
  }
  if (first_utime_ < 0) return;
  const auto period = terminal_ ? std::chrono::milliseconds(250) : std::chrono::milliseconds(10'000);
  const bool changed = state_.state != shown_state_;
  if (!changed && Clock::now() - shown_ < period) return;
  shown_ = Clock::now();
  shown_state_ = state_.state;
  std::printf(terminal_ ? "\r\033[K%s" : "%s\n", line().c_str());
  std::fflush(stdout);
}

void Progress::finish() {
  if (terminal_ && first_utime_ >= 0) std::printf("\n");
}

}  // namespace rover
