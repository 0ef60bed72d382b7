#include "tools/status/convert.hpp"

#include <array>

#include "common/bus/service_names.hpp"
#include "common/bus/state_names.hpp"

namespace rover::status {
namespace {

constexpr std::array kConditions = {"FALSE", "TRUE", "STALE", "INVALID"};

template <size_t N>
std::string name_of(const std::array<const char*, N>& names, std::int8_t value) {
  const auto index = static_cast<size_t>(value);
  return index < N ? names[index] : "?";
}

Health health_of(std::int8_t status) {
  switch (status) {
    case heartbeat_t::OK:
      return Health::kOk;
    case heartbeat_t::DEGRADED:
      return Health::kDegraded;
    case heartbeat_t::FAULT:
      return Health::kFault;
    default:
      return Health::kUnknown;
  }
}

}  // namespace

MessageInfo message_info(const std::string& channel, const header_t& header, size_t bytes) {
  return {channel, header.publisher, header.boot_id, header.seq, header.utime, bytes};
}

Heartbeat report_from(const heartbeat_t& message) {
  Heartbeat out;
  out.utime = message.header.utime;
  out.service = message.service;
  out.pid = message.pid;
  out.health = health_of(message.status);
  out.text = message.text;
  out.step_p50_ms = message.step_p50_ms;
  out.step_p99_ms = message.step_p99_ms;
  for (const input_health_t& input : message.inputs) {
    out.gaps += input.gaps;
    out.malformed += input.malformed;
    out.out_of_order += input.out_of_order;
    // The recorder's one input is all channels.
    if (input.received > 0 && input.channel != ".*") out.newest_input[input.channel] = input.last_utime;
  }
  return out;
}

StateReport report_from(const supervisor_state_t& message) {
  StateReport out;
  out.utime = message.header.utime;
  out.state = state_name(message.state);
  out.level = level_name(message.level);
  if (message.full_stopped != 0) out.stopped.assign(kFullServiceNames.begin(), kFullServiceNames.end());
  out.since = message.since_utime;
  out.cause = message.cause;
  out.quantity = message.quantity;
  out.value = message.value;
  out.threshold = message.threshold;
  out.hazard_stops = message.hazard_stops;
  out.faults = message.faults;
  return out;
}

PermitReport report_from(const drive_permit_t& message) {
  return {message.granted == 1, message.reason};
}

FaultReport report_from(const fault_t& message) {
  FaultReport out;
  out.utime = message.header.utime;
  out.id = message.id;
  out.condition = name_of(kConditions, message.condition);
  out.response = response_name(message.response);
  out.value = message.value;
  out.limit = message.limit;
  out.visible = message.visible_utime;
  out.active = message.active == 1;
  return out;
}

}  // namespace rover::status
