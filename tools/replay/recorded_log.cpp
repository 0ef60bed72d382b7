#include "tools/replay/recorded_log.hpp"

#include <lcm/lcm.h>

#include <algorithm>
#include <rover/tick_t.hpp>
#include <tuple>
#include <utility>

#include "common/bus/channel_types.hpp"
#include "common/bus/channels.hpp"
#include "common/bus/config.hpp"
#include "common/bus/streams.hpp"

namespace rover::replay {
namespace {

// Empty if the message is not a valid TICK.
std::optional<tick_t> tick_of(const LogMessage& message) {
  tick_t tick{};
  if (message.channel != channel::kTick || !message.header) return std::nullopt;
  const int size = static_cast<int>(message.bytes.size());
  if (!find_channel_type(channel::kTick)->decodes(message.bytes.data(), size)) return std::nullopt;
  if (!decode_message(message.bytes.data(), size, tick)) return std::nullopt;
  return tick;
}

bool can_be_sent(const LogMessage& message) {
  const std::string& name = message.channel;
  return name.size() <= LCM_MAX_CHANNEL_NAME_LENGTH && name.find('\0') == std::string::npos;
}

using StreamKey = std::tuple<std::string, std::string, std::int64_t>;

void note(std::map<StreamKey, RecordedStream>& streams, const LogMessage& message) {
  if (!message.header) return;
  const header_t& header = *message.header;
  RecordedStream& stream = streams[{message.channel, header.publisher, header.boot_id}];
  if (stream.count++ == 0)
    stream = {message.channel, header.publisher, header.boot_id, header.seq, header.seq, 1, header.release_utime};
  stream.last_seq = std::max(stream.last_seq, header.seq);
  stream.last_release = std::max(stream.last_release, header.release_utime);
}

}  // namespace

RecordedLog::RecordedLog(const std::string& log_or_run, int log_run)
    : run_(choose_run(log_or_run, log_run)), parts_(log_parts(run_.log)) {
  if (run_.last_tick == kNever)
    throw ConfigError(run_.log + ": not a log of a rover: it contains no TICK" +
                      (run_.bad_ticks > 0 ? " of this version" : ""));
  scan();
  seek(ticks_.front());
}

void RecordedLog::open(const LogPlace& place) {
  if (!reader_ || place.part != place_.part) reader_ = std::make_unique<EventLogReader>(parts_[place.part]);
  reader_->seek(place.offset);
  place_ = place;
}

std::optional<LogMessage> RecordedLog::next_message() {
  LogEvent event;
  while (!reader_->next(event)) {
    if (place_.part >= run_.end.part) return std::nullopt;
    open({place_.part + 1, 0});
  }
  if (LogPlace{place_.part, event.begin} >= run_.end) return std::nullopt;
  place_.offset = event.end;
  LogMessage message{event.channel, std::nullopt, {event.data, event.data + event.size}};
  header_t header{};
  if (peek_header(event.data, event.size, header)) message.header = std::move(header);
  return message;
}

void RecordedLog::scan() {
  std::map<StreamKey, RecordedStream> streams;
  LogPlace group = run_.begin;
  std::int64_t since_tick = 0;
  std::vector<std::string> members;  // of the tick before
  open(run_.begin);
  while (const auto message = next_message()) {
    if (!can_be_sent(*message)) {
      ++left_messages_;
      continue;
    }
    note(streams, *message);
    ++since_tick;
    const auto tick = tick_of(*message);
    if (!tick || (!ticks_.empty() && tick->header.utime <= ticks_.back())) continue;  // a tick repeated for a late node
    by_the_clock_ = by_the_clock_ || tick->mode == tick_t::REALTIME;
    for (const std::string& name : std::exchange(members, tick->members))
      if (std::find(members.begin(), members.end(), name) == members.end()) left_.try_emplace(name, tick->header.utime);
    ticks_.push_back(tick->header.utime);
    places_.push_back(group);
    group = place_;
    since_tick = 0;
  }
  left_messages_ += since_tick;
  for (auto& [key, stream] : streams) streams_.push_back(std::move(stream));
}

std::optional<TickGroup> RecordedLog::next() {
  TickGroup group;
  while (auto message = next_message()) {
    if (!can_be_sent(*message)) continue;
    if (message->channel != channel::kTick) {
      group.messages.push_back(std::move(*message));
      continue;
    }
    const auto tick = tick_of(*message);
    if (!tick || tick->header.utime <= newest_tick_) continue;
    group.tick = newest_tick_ = tick->header.utime;
    group.tick_message = std::move(*message);
    return group;
  }
  return std::nullopt;
}

void RecordedLog::seek(Utime t) {
  const auto it = std::lower_bound(ticks_.begin(), ticks_.end(), t);
  const size_t index = std::min(static_cast<size_t>(it - ticks_.begin()), ticks_.size() - 1);
  open(places_[index]);
  newest_tick_ = index == 0 ? kNever : ticks_[index - 1];
}

std::map<std::int64_t, Utime> boots_of(const RecordedLog& log, const std::string& service) {
  std::map<std::int64_t, Utime> boots;
  for (const RecordedStream& stream : log.streams()) {
    if (stream.publisher != service) continue;
    Utime& last = boots.try_emplace(stream.boot_id, stream.last_release).first->second;
    last = std::max(last, stream.last_release);
  }
  return boots;
}

}  // namespace rover::replay
