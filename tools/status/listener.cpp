#include "tools/status/listener.hpp"

#include <algorithm>
#include <rover/tick_t.hpp>

#include "common/bus/channel_types.hpp"
#include "common/bus/channels.hpp"
#include "common/bus/streams.hpp"
#include "tools/status/convert.hpp"

namespace rover::status {
namespace {

// Decodes the message and passes it to the handler.
template <class Message, class Take>
bool decoded(const void* data, int size, Take dispatch) {
  Message message;
  if (!decode_message(data, size, message)) return false;
  dispatch(message);
  return true;
}

bool right_type(const std::string& channel, const void* data, int size) {
  const ChannelType* type = find_channel_type(channel);
  return type == nullptr || peek_fingerprint(data, size) == type->fingerprint;
}

}  // namespace

Listener::Listener(lcm::LCM& lcm, BusStatistics& statistics, std::function<double()> wall_s)
    : lcm_(lcm), statistics_(statistics), wall_s_(std::move(wall_s)) {
  auto* subscription = lcm_.subscribeFunction(
      ".*",
      +[](const lcm::ReceiveBuffer* buffer, const std::string& channel, Listener* self) {
        self->receive(channel, buffer->data, static_cast<int>(buffer->data_size));
      },
      this);
  // Unlimited queue: messages that LCM drops would be counted as gaps of the bus.
  subscription->setQueueCapacity(0);
}

void Listener::receive(const std::string& channel, const void* data, int size) {
  // Skip LCM's self test, and DONE if it shares the bus.
  if (channel == "LCM_SELF_TEST" || channel == channel::kDone) return;
  header_t header{};
  if (!right_type(channel, data, size) || !peek_header(data, size, header) || !dispatch(channel, header, data, size))
    return statistics_.add_malformed(channel);
  statistics_.add_message(message_info(channel, header, static_cast<size_t>(size)));
}

bool Listener::dispatch(const std::string& channel, const header_t& header, const void* data, int size) {
  if (channel == channel::kTick)
    return decoded<tick_t>(data, size,
                           [&](const auto&) { statistics_.add_tick(header.publisher, header.utime, wall_s_()); });
  if (channel == channel::kHeartbeat)
    return decoded<heartbeat_t>(data, size, [&](const auto& m) { statistics_.add_heartbeat(report_from(m)); });
  if (channel == channel::kState)
    return decoded<supervisor_state_t>(data, size, [&](const auto& m) { statistics_.add_state(report_from(m)); });
  if (channel == channel::kDrivePermit)
    return decoded<drive_permit_t>(data, size, [&](const auto& m) { statistics_.add_permit(report_from(m)); });
  if (channel == channel::kFault)
    return decoded<fault_t>(data, size, [&](const auto& m) { statistics_.add_fault(report_from(m)); });
  return true;
}

bool Listener::listen_until(double wall_s, const std::function<bool()>& running) {
  constexpr int kLongestMs = 50;
  for (double left_s = wall_s - wall_s_(); left_s > 0.0 && running(); left_s = wall_s - wall_s_()) {
    const int wait_ms = std::clamp(static_cast<int>(left_s * 1e3), 1, kLongestMs);
    if (lcm_.handleTimeout(wait_ms) < 0 && running()) return false;
  }
  return true;
}

}  // namespace rover::status
