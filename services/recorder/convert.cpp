#include "recorder/convert.hpp"

#include <rover/fault_t.hpp>
#include <rover/path_t.hpp>
#include <rover/supervisor_state_t.hpp>
#include <utility>

namespace rover::recorder {
namespace {

template <class Message>
bool decode(const RawMessage& raw, Message& message) {
  return decode_message(raw.bytes.data(), static_cast<int>(raw.bytes.size()), message);
}

}  // namespace

Event event_from(const RawMessage& raw) {
  Event event;
  event.release = raw.header.release_utime;
  event.utime = raw.header.utime;
  event.kind = raw.channel == channel::kTick ? Event::Kind::kTick : Event::Kind::kData;
  event.channel = raw.channel;
  event.publisher = raw.header.publisher;
  event.boot_id = raw.header.boot_id;
  event.seq = raw.header.seq;
  event.bytes = raw.bytes;
  return event;
}

bool TriggerFinder::is_trigger(const RawMessage& raw) {
  if (raw.channel == channel::kState) {
    supervisor_state_t state{};
    if (!decode(raw, state) || state.state == state_) return false;
    state_ = state.state;
    return state_ != supervisor_state_t::BOOT && state_ != supervisor_state_t::STANDBY;
  }
  if (raw.channel == channel::kPath) {
    path_t path{};
    // PATH is repeated every second; only a new id is a trigger.
    return decode(raw, path) && path.kind != path_t::GLOBAL && std::exchange(path_id_, path.path_id) != path.path_id;
  }
  if (raw.channel == channel::kFault) {
    fault_t fault{};
    return decode(raw, fault) && fault.active != 0;
  }
  return false;
}

}  // namespace rover::recorder
