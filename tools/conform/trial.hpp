// Command sequence of the trial, by message time: damaged commands, and on request commands that move the rover.
#pragma once

#include <array>
#include <optional>
#include <variant>

#include "common/core/time.hpp"

namespace rover::conform {

// A WHEEL_COMMAND.
struct Command {
  Utime valid_until = 0;
  std::array<double, 6> rate_radps{};
  std::array<double, 4> steer_rad{};
};
// Bytes that are not a WHEEL_COMMAND: truncated, or of another type.
enum class Damaged { kCut, kForeign };

struct TrialConfig {
  bool move = false;
  double rate_radps = 0.4;  // 0.05 m/s at a wheel's radius of 0.125 m
  double steer_rad = 0.2;   // front wheels to the left, rear ones to the right
  double validity_s = 0.2;
};

// A phase of the trial, in seconds from its start.
struct Phase {
  double from_s;
  double until_s;
};
inline constexpr Phase kDamagedPhase{0.0, 1.0};
inline constexpr Phase kForwardPhase{1.0, 3.0};
inline constexpr Phase kNoCommandPhase{3.0, 5.0};
inline constexpr Phase kExpiredPhase{5.0, 6.0};
inline constexpr Phase kNanPhase{6.0, 7.0};
inline constexpr Phase kSteerPhase{7.0, 9.0};
inline constexpr Phase kTurnPhase{9.0, 12.0};
inline constexpr Phase kLastPhase{12.0, 13.0};

class Trial {
 public:
  using Output = std::variant<Command, Damaged>;
  Trial(const TrialConfig& config, Utime begin) : config_(config), begin_(begin) {}

  // The output at this tick, if any.
  std::optional<Output> step(Utime now) const;
  bool over(Utime now) const { return seconds(now) > (config_.move ? kLastPhase : kDamagedPhase).until_s; }

  const TrialConfig& config() const { return config_; }
  double seconds(Utime t) const { return to_seconds(t - begin_); }

 private:
  Command command(double rate_radps, double steer_rad, Utime valid_until) const;
  TrialConfig config_;
  Utime begin_;
};

}  // namespace rover::conform
