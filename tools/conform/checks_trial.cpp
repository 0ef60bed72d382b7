#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/core/frames.hpp"
#include "tools/conform/checks.hpp"

namespace rover::conform {
namespace {

constexpr double kAtRest = 0.02;        // [rad/s]
constexpr double kStopS = 0.5;          // from the end of validity to standstill
constexpr double kSettleS = 1.0;        // until the wheels reach the commanded rate
constexpr double kRateTolerance = 0.3;  // allowed relative deviation from the command
constexpr double kEncoderShare = 0.2;
constexpr double kMinTurnRad = 0.01;

// The received messages of one phase, by utime.
template <class Message>
std::vector<const Message*> during(const std::vector<Message>& messages, const Trial& trial, double from_s,
                                   double until_s) {
  std::vector<const Message*> out;
  for (const Message& message : messages) {
    const double s = trial.seconds(message.stamp.utime);
    if (s >= from_s && s < until_s) out.push_back(&message);
  }
  return out;
}

double fastest(const std::vector<const ReceivedWheels*>& wheels) {
  double rate = 0.0;
  for (const ReceivedWheels* sample : wheels)
    for (double value : sample->rate_radps) rate = std::fmax(rate, std::abs(value));
  return rate;
}

double max_reverse_rate(const std::vector<const ReceivedWheels*>& wheels) {
  double rate = 0.0;
  for (const ReceivedWheels* sample : wheels)
    for (double value : sample->rate_radps) rate = std::fmin(rate, value);
  return rate;
}

bool all_finite(const std::vector<const ReceivedWheels*>& wheels) {
  return std::all_of(wheels.begin(), wheels.end(), [](const ReceivedWheels* sample) { return sample->finite; });
}

Line damaged_line(const Received& received, const Trial& trial) {
  const std::string requirement = "dropped: wheels stay at rest, WHEEL_STATE continues";
  const auto wheels = during(received.wheels, trial, kDamagedPhase.from_s, kDamagedPhase.until_s);
  const auto expected = static_cast<size_t>((kDamagedPhase.until_s - kDamagedPhase.from_s) / to_seconds(kTickUs));
  const double rate = fastest(wheels);
  return line("damaged commands", rate <= kAtRest && wheels.size() > expected / 2,
              fmt::format("fastest wheel {:.3f} rad/s, {} of {} WHEEL_STATE", rate, wheels.size(), expected),
              requirement);
}

Line follow_line(const Received& received, const Trial& trial) {
  const double wanted = trial.config().rate_radps;
  const std::string requirement = fmt::format("{:.2f} rad/s, positive forward, encoders agree", wanted);
  const auto wheels = during(received.wheels, trial, kForwardPhase.from_s + kSettleS, kForwardPhase.until_s);
  if (wheels.size() < 2) return line("follows", false, "no WHEEL_STATE", requirement);
  double slowest = kInfinity;
  double worst_encoder = 0.0;
  const double covered_s = to_seconds(wheels.back()->stamp.utime - wheels.front()->stamp.utime);
  for (size_t i = 0; i < 6; ++i) {
    double mean = 0.0;
    for (const ReceivedWheels* sample : wheels) mean += sample->rate_radps[i] / static_cast<double>(wheels.size());
    const double turned = (wheels.back()->angle_rad[i] - wheels.front()->angle_rad[i]) / covered_s;
    if (std::abs(mean - wanted) > std::abs(slowest - wanted) || slowest == kInfinity) slowest = mean;
    worst_encoder = std::max(worst_encoder, std::abs(turned - mean));
  }
  return line("follows",
              std::abs(slowest - wanted) <= kRateTolerance * wanted && worst_encoder <= kEncoderShare * wanted,
              fmt::format("worst wheel {:.2f} rad/s, encoder {:.3f} rad/s off", slowest, worst_encoder), requirement);
}

Line watchdog_line(const Received& received, const Trial& trial) {
  const double due_s = kNoCommandPhase.from_s + trial.config().validity_s + kStopS;
  const std::string requirement = fmt::format("at rest {:.1f} s after valid_until_utime", kStopS);
  const auto wheels = during(received.wheels, trial, due_s, kNoCommandPhase.until_s);
  if (wheels.empty()) return line("watchdog", false, "no WHEEL_STATE", requirement);
  double moved_until_s = 0.0;
  for (const ReceivedWheels* sample : during(received.wheels, trial, kNoCommandPhase.from_s, kNoCommandPhase.until_s))
    if (fastest({sample}) > kAtRest) moved_until_s = trial.seconds(sample->stamp.utime) - kNoCommandPhase.from_s;
  return line("watchdog", fastest(wheels) <= kAtRest,
              fmt::format("last motion {:.2f} s after the last command", moved_until_s), requirement);
}

Line status_line(const Received& received, const Trial& trial) {
  const std::string requirement = "WHEEL_STATE reports COMMAND_EXPIRED";
  const double from_s = kNoCommandPhase.from_s + trial.config().validity_s + 0.2;
  const auto wheels = during(received.wheels, trial, from_s, kNoCommandPhase.until_s);
  if (wheels.empty()) return line("status when expired", false, "no WHEEL_STATE", requirement);
  const auto reported = std::count_if(wheels.begin(), wheels.end(), [](const auto* w) { return w->command_expired; });
  return line("status when expired", reported == static_cast<std::ptrdiff_t>(wheels.size()),
              fmt::format("in {} of {}", reported, wheels.size()), requirement);
}

Line refused_line(const std::string& check, const Received& received, const Trial& trial, const Phase& phase) {
  const std::string requirement = "rejected";
  // Motion of the previous phase may end first.
  const auto wheels = during(received.wheels, trial, phase.from_s + kStopS, phase.until_s);
  if (wheels.empty()) return line(check, false, "no WHEEL_STATE", requirement);
  const double rate = max_reverse_rate(wheels);
  return line(check, rate >= -kAtRest && all_finite(wheels), fmt::format("{:.3f} rad/s backwards", std::abs(rate)),
              requirement);
}

Line steering_line(const Received& received, const Trial& trial) {
  const double wanted = trial.config().steer_rad;
  const std::string requirement =
      fmt::format("front wheels to {:+.2f} rad (left), rear ones to {:+.2f}", wanted, -wanted);
  const auto wheels = during(received.wheels, trial, kSteerPhase.until_s - 0.2, kSteerPhase.until_s);
  if (wheels.empty()) return line("steering", false, "no WHEEL_STATE", requirement);
  const std::array<double, 4>& s = wheels.back()->steer_rad;
  const auto near = [&](double angle, double goal) { return std::abs(angle - goal) <= 0.5 * wanted; };
  return line("steering", near(s[0], wanted) && near(s[1], wanted) && near(s[2], -wanted) && near(s[3], -wanted),
              fmt::format("{:+.2f} {:+.2f} {:+.2f} {:+.2f} rad", s[0], s[1], s[2], s[3]), requirement);
}

Line turn_line(const Received& received, const Trial& trial) {
  const std::string requirement = "positive to the left, both gyros";
  const auto imu = during(received.imu, trial, kTurnPhase.from_s, kTurnPhase.until_s);
  if (imu.empty()) return line("sense of turn", false, "no IMU", requirement);
  double gyro = 0.0;
  double fog = 0.0;
  for (const ReceivedImu* sample : imu) {
    gyro += sample->delta_angle_rad.z();
    fog += sample->fog_delta_yaw_rad;
  }
  return line("sense of turn", gyro >= kMinTurnRad && fog >= kMinTurnRad,
              fmt::format("gyro {:+.3f} rad, fibre-optic gyro {:+.3f} rad", gyro, fog), requirement);
}

}  // namespace

std::vector<Line> check_trial(const Received& received, const Trial& trial) {
  std::vector<Line> lines{damaged_line(received, trial)};
  if (!trial.config().move) {
    for (const char* check : {"follows", "watchdog", "status when expired", "expired commands", "commands with NaN",
                              "steering", "sense of turn"})
      lines.push_back(skipped(check, "requires --move: the rover moves", ""));
    return lines;
  }
  lines.push_back(follow_line(received, trial));
  lines.push_back(watchdog_line(received, trial));
  lines.push_back(status_line(received, trial));
  lines.push_back(refused_line("expired commands", received, trial, kExpiredPhase));
  lines.push_back(refused_line("commands with NaN", received, trial, kNanPhase));
  lines.push_back(steering_line(received, trial));
  lines.push_back(turn_line(received, trial));
  return lines;
}

}  // namespace rover::conform
