#include "tools/status/health.hpp"

#include <algorithm>
#include <cmath>

namespace rover::status {
namespace {

constexpr double kStaleS = 1.0;  // equal to the supervisor's heartbeat limit
constexpr double kPeriods = 3.0;

}  // namespace

Piece condition_of(const ServiceStatus& service) {
  if (!service.wanted && !service.process.alive) return {"stopped", Colour::kPlain};
  if (!service.process.alive) return {"dead", Colour::kRed};
  if (service.quiet_s > kStaleS) return {"silent", Colour::kRed};
  if (std::isnan(service.age_s)) return {"waiting", Colour::kYellow};
  if (service.age_s > kStaleS) return {"stale", Colour::kRed};
  const Health health = service.heartbeat ? service.heartbeat->health : Health::kOk;
  if (health == Health::kOk) return {"OK", Colour::kPlain};
  if (health == Health::kDegraded) return {"DEGRADED", Colour::kYellow};
  return {health == Health::kFault ? "FAULT" : "?", Colour::kRed};
}

Colour colour_of_state(const std::string& state) {
  if (state == "FAULT_STOP" || state == "SAFE" || state == "?") return Colour::kRed;
  if (state == "HAZARD_STOP" || state == "PAUSED") return Colour::kYellow;
  return Colour::kBold;
}

bool is_stale(const ChannelStatus& channel) {
  return channel.hz > 0.0 && channel.age_s > std::max(kStaleS, kPeriods / channel.hz);
}

}  // namespace rover::status
