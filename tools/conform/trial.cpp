#include "tools/conform/trial.hpp"

#include "common/core/frames.hpp"

namespace rover::conform {
namespace {

bool in(const Phase& phase, double s) {
  return s >= phase.from_s && s < phase.until_s;
}

}  // namespace

Command Trial::command(double rate_radps, double steer_rad, Utime valid_until) const {
  Command out;
  out.valid_until = valid_until;
  out.rate_radps.fill(rate_radps);
  out.steer_rad = {steer_rad, steer_rad, -steer_rad, -steer_rad};
  return out;
}

// Commands to be rejected drive backward: obeying one differs from coasting forward.
std::optional<Trial::Output> Trial::step(Utime now) const {
  const double s = seconds(now);
  const Utime valid = now + to_utime(config_.validity_s);
  const auto each_fifth = now / kTickUs % 5;
  if (in(kDamagedPhase, s)) {
    if (each_fifth == 0) return Damaged::kCut;
    if (each_fifth == 2) return Damaged::kForeign;
    return {};
  }
  if (!config_.move) return {};
  if (in(kForwardPhase, s)) return command(config_.rate_radps, 0.0, valid);
  if (in(kExpiredPhase, s)) return command(-config_.rate_radps, 0.0, now - kTickUs);
  if (in(kNanPhase, s)) {
    Command broken = command(-config_.rate_radps, 0.0, valid);
    broken.rate_radps[0] = kNaN;
    return broken;
  }
  if (in(kSteerPhase, s)) return command(0.0, config_.steer_rad, valid);
  if (in(kTurnPhase, s)) return command(config_.rate_radps, config_.steer_rad, valid);
  if (in(kLastPhase, s)) return command(0.0, 0.0, valid);
  return {};
}

}  // namespace rover::conform
