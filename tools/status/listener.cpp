#include "tools/status/listener.hpp"

#include <algorithm>
#include <rover/tick_t.hpp>

#include "common/bus/channel_types.hpp"
#include "common/bus/channels.hpp"
#include "common/bus/streams.hpp"
#include "tools/status/convert.hpp"

namespace rover::status {
namespace {

// Hands over what decodes.
template <class Message, class Take>
bool decoded(const void* data, int size, Take take) {
  Message message;
  if (!decode_message(data, size, message)) return false;
  take(message);
  return true;
}

bool right_type(const std::string& channel, const void* data, int size) {
  const ChannelType* type = find_channel_type(channel);
  return type == nullptr || peek_fingerprint(data, size) == type->fingerprint;
}

}  // namespace

Listener::Listener(lcm::LCM& lcm, Account& account, std::function<double()> wall_s)
    : lcm_(lcm), account_(account), wall_s_(std::move(wall_s)) {
  auto* subscription = lcm_.subscribeFunction(
      ".*",
      +[](const lcm::ReceiveBuffer* buffer, const std::string& channel, Listener* self) {
        self->receive(channel, buffer->data, static_cast<int>(buffer->data_size));
      },
      this);
  // What LCM drops from a full queue would look like a gap of the bus.
  subscription->setQueueCapacity(0);
}

void Listener::receive(const std::string& channel, const void* data, int size) {
  // LCM's own, and reports of lockstep where they share the bus: DONE is no channel of it.
  if (channel == "LCM_SELF_TEST" || channel == channel::kDone) return;
  header_t header{};
  if (!right_type(channel, data, size) || !peek_header(data, size, header) || !take(channel, header, data, size))
    return account_.hear_malformed(channel);
  account_.hear(heard_from(channel, header, static_cast<size_t>(size)));
}

bool Listener::take(const std::string& channel, const header_t& header, const void* data, int size) {
  if (channel == channel::kTick)
    return decoded<tick_t>(data, size,
                           [&](const auto&) { account_.hear_tick(header.publisher, header.utime, wall_s_()); });
  if (channel == channel::kHeartbeat)
    return decoded<heartbeat_t>(data, size, [&](const auto& m) { account_.hear_heartbeat(report_from(m)); });
  if (channel == channel::kState)
    return decoded<supervisor_state_t>(data, size, [&](const auto& m) { account_.hear_state(report_from(m)); });
  if (channel == channel::kDrivePermit)
    return decoded<drive_permit_t>(data, size, [&](const auto& m) { account_.hear_permit(report_from(m)); });
  if (channel == channel::kFault)
    return decoded<fault_t>(data, size, [&](const auto& m) { account_.hear_fault(report_from(m)); });
  return true;
}

bool Listener::listen_until(double wall_s, const std::function<bool()>& going) {
  constexpr int kLongestMs = 50;
  for (double left_s = wall_s - wall_s_(); left_s > 0.0 && going(); left_s = wall_s - wall_s_()) {
    const int wait_ms = std::clamp(static_cast<int>(left_s * 1e3), 1, kLongestMs);
    if (lcm_.handleTimeout(wait_ms) < 0 && going()) return false;
  }
  return true;
}

}  // namespace rover::status
