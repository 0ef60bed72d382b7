#include "tools/status/snapshot_json.hpp"

#include <cmath>

#include "tools/status/health.hpp"

namespace rover::status {
namespace {

using Json = nlohmann::ordered_json;

// Rounds off digits below the measurement accuracy.
Json number(double value) {
  return std::isfinite(value) ? Json(std::round(value * 1e6) / 1e6) : Json(nullptr);
}

Json text(const std::string& value) {
  return value.empty() ? Json(nullptr) : Json(value);
}

Json utime(Utime value) {
  return value == kNever ? Json(nullptr) : Json(value);
}

Json process_json(const ServiceStatus& service) {
  const ProcessFigures& p = service.process;
  return {{"pid", p.pid > 0 ? Json(p.pid) : Json(nullptr)},
          {"alive", p.alive},
          {"age_s", number(service.age_s)},
          {"restarts", p.restarts ? Json(*p.restarts) : Json(nullptr)},
          {"cpu_percent", number(p.cpu_percent)},
          {"rss_mb", number(p.rss_mb)}};
}

Json service_json(const ServiceStatus& service) {
  Json out = process_json(service);
  out["condition"] = condition_of(service).text;
  if (!service.heartbeat) return out;
  const Heartbeat& beat = *service.heartbeat;
  out["text"] = text(beat.text);
  out["step_p50_ms"] = number(beat.step_p50_ms);
  out["step_p99_ms"] = number(beat.step_p99_ms);
  out["gaps"] = beat.gaps;
  out["malformed"] = beat.malformed;
  out["out_of_order"] = beat.out_of_order;
  return out;
}

Json fault_json(const FaultStatus& fault) {
  const FaultReport& r = fault.report;
  return {{"id", r.id},
          {"value", number(r.value)},
          {"limit", number(r.limit)},
          {"condition", text(r.condition)},
          {"response", text(r.response)},
          {"for_s", number(fault.for_s)}};
}

Json channel_json(const ChannelStatus& c) {
  return {{"hz", number(c.hz)},       {"age_s", number(c.age_s)},     {"gaps", c.gaps},
          {"malformed", c.malformed}, {"wall_hz", number(c.wall_hz)}, {"bytes_per_s", number(c.bytes_per_s)}};
}

Json cause_json(const StateReport& state) {
  const bool measured = !state.quantity.empty();
  return {{"cause", text(state.cause)},
          {"quantity", text(state.quantity)},
          {"value", number(measured ? state.value : kNaN)},
          {"threshold", number(measured ? state.threshold : kNaN)}};
}

Json permit_json(const PermitReport& permit) {
  return {{"granted", permit.granted}, {"reason", text(permit.reason)}};
}

Json clock_json(const Snapshot& s) {
  return {{"utime", utime(s.now)},
          {"realtime_factor", number(s.realtime_factor)},
          {"tick_silence_s", number(s.tick_silence_s)}};
}

}  // namespace

Json to_json(const Snapshot& s) {
  Json out = {{"state", s.state ? text(s.state->state) : Json(nullptr)},
              {"level", s.state ? text(s.state->level) : Json(nullptr)},
              {"services", Json::object()},
              {"faults", Json::array()},
              {"channels", Json::object()}};
  for (const auto& [name, service] : s.services) out["services"][name] = service_json(service);
  for (const FaultStatus& fault : s.faults) out["faults"].push_back(fault_json(fault));
  for (const auto& [name, channel] : s.channels) out["channels"][name] = channel_json(channel);
  out["state_for_s"] = number(s.state_for_s);
  out["transition"] = s.state ? cause_json(*s.state) : Json(nullptr);
  out["permit"] = s.permit ? permit_json(*s.permit) : Json(nullptr);
  out["hazard_stops"] = s.state ? Json(s.state->hazard_stops) : Json(nullptr);
  out["clock"] = clock_json(s);
  out["run"] = text(s.run_dir);
  out["bus"] = s.bus_url;
  return out;
}

}  // namespace rover::status
