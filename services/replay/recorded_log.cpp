#include "replay/recorded_log.hpp"

#include <algorithm>
#include <filesystem>
#include <rover/tick_t.hpp>
#include <tuple>

#include "common/bus/channels.hpp"
#include "common/bus/config.hpp"
#include "common/bus/event_log.hpp"
#include "common/bus/streams.hpp"

namespace rover::replay {
namespace {

using EventPtr = std::unique_ptr<lcm_eventlog_event_t, void (*)(lcm_eventlog_event_t*)>;

EventPtr read_event(lcm_eventlog_t* log) {
  return {lcm_eventlog_read_next_event(log), [](lcm_eventlog_event_t* event) { lcm_eventlog_free_event(event); }};
}

// Empty where the message is no tick.
std::optional<tick_t> tick_of(const LogMessage& message) {
  tick_t tick{};
  if (message.channel != channel::kTick) return std::nullopt;
  if (!decode_message(message.bytes.data(), static_cast<int>(message.bytes.size()), tick)) return std::nullopt;
  return tick;
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

RecordedLog::RecordedLog(const std::string& path)
    : file_(nullptr, [](lcm_eventlog_t* log) { lcm_eventlog_destroy(log); }) {
  if (!std::filesystem::is_regular_file(path)) throw ConfigError(path + ": no such log");
  parts_ = log_parts(path);
  look_through();
  if (ticks_.empty()) throw ConfigError(path + ": no log of a rover: it holds no TICK");
  seek(ticks_.front());
}

void RecordedLog::open_part(size_t part, std::int64_t offset) {
  if (!file_ || part != part_) {
    file_.reset(lcm_eventlog_create(parts_[part].c_str(), "r"));
    if (!file_) throw ConfigError(parts_[part] + ": cannot be read");
    part_ = part;
  }
  fseeko(file_->f, offset, SEEK_SET);
}

std::optional<LogMessage> RecordedLog::next_message() {
  EventPtr event = read_event(file_.get());
  while (!event && part_ + 1 < parts_.size()) {
    open_part(part_ + 1, 0);
    event = read_event(file_.get());
  }
  if (!event) return std::nullopt;
  LogMessage message;
  message.channel.assign(event->channel, static_cast<size_t>(event->channellen));
  const auto* begin = static_cast<const std::uint8_t*>(event->data);
  message.bytes.assign(begin, begin + event->datalen);
  header_t header{};
  if (peek_header(message.bytes.data(), event->datalen, header)) message.header = std::move(header);
  return message;
}

void RecordedLog::look_through() {
  std::map<StreamKey, RecordedStream> streams;
  open_part(0, 0);
  Place group{0, 0};
  Place end{0, 0};
  const auto left_in_part = [this](const Place& place) {
    return static_cast<std::int64_t>(std::filesystem::file_size(parts_[place.part])) - place.offset;
  };
  while (const auto message = next_message()) {
    if (part_ != end.part) left_bytes_ += left_in_part(end);
    end = {part_, ftello(file_->f)};
    note(streams, *message);
    const auto tick = tick_of(*message);
    if (!tick || (!ticks_.empty() && tick->header.utime <= ticks_.back())) continue;  // given again to a late node
    by_the_clock_ = by_the_clock_ || tick->mode == tick_t::REALTIME;
    ticks_.push_back(tick->header.utime);
    places_.push_back(group);
    group = end;
  }
  left_bytes_ += left_in_part(end);
  for (auto& [key, stream] : streams) streams_.push_back(std::move(stream));
}

std::optional<TickGroup> RecordedLog::next() {
  TickGroup group;
  while (auto message = next_message()) {
    if (message->channel != channel::kTick) {
      group.messages.push_back(std::move(*message));
      continue;
    }
    const auto tick = tick_of(*message);
    if (!tick || tick->header.utime <= given_) continue;
    group.tick = given_ = tick->header.utime;
    group.tick_message = std::move(*message);
    return group;
  }
  return std::nullopt;
}

void RecordedLog::seek(Utime t) {
  const auto it = std::lower_bound(ticks_.begin(), ticks_.end(), t);
  const size_t index = std::min(static_cast<size_t>(it - ticks_.begin()), ticks_.size() - 1);
  open_part(places_[index].part, places_[index].offset);
  given_ = index == 0 ? kNever : ticks_[index - 1];
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
