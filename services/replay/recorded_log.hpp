// A log as replay takes it: tick by tick, each with the messages that belong before it.
#pragma once

#include <lcm/eventlog.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <rover/header_t.hpp>
#include <string>
#include <vector>

#include "common/core/time.hpp"

namespace rover::replay {

struct LogMessage {
  std::string channel;
  std::optional<header_t> header;  // empty: not readable
  std::vector<std::uint8_t> bytes;
};

struct TickGroup {
  Utime tick = kNever;
  std::vector<LogMessage> messages;  // as recorded, TICK excluded
  LogMessage tick_message;
};

// What one process said on one channel.
struct RecordedStream {
  std::string channel;
  std::string publisher;
  std::int64_t boot_id = 0;
  std::int64_t first_seq = 0;
  std::int64_t last_seq = 0;
  std::int64_t count = 0;
  Utime last_release = kNever;
};

class RecordedLog {
 public:
  // Looks through the whole log, all parts of it (event_log.hpp). Throws ConfigError with one line where it holds no
  // ticks.
  explicit RecordedLog(const std::string& path);

  const std::vector<Utime>& ticks() const { return ticks_; }
  const std::vector<RecordedStream>& streams() const { return streams_; }
  // Whether the ticks followed the clock: such a run is not repeated exactly.
  bool by_the_clock() const { return by_the_clock_; }
  // Bytes behind the last whole record of each part.
  std::int64_t left_bytes() const { return left_bytes_; }

  // The group of the next tick; nothing at the end.
  std::optional<TickGroup> next();
  // next() then gives the first tick not before t.
  void seek(Utime t);

 private:
  struct Place {
    size_t part;
    std::int64_t offset;
  };
  // Of one file, from its current place on; empty at its end.
  std::optional<LogMessage> next_message();
  void open_part(size_t part, std::int64_t offset);
  void look_through();

  std::vector<std::string> parts_;
  std::unique_ptr<lcm_eventlog_t, void (*)(lcm_eventlog_t*)> file_;
  size_t part_ = 0;  // that is open
  std::vector<Utime> ticks_;
  std::vector<Place> places_;  // of the first record after the tick before
  std::vector<RecordedStream> streams_;
  bool by_the_clock_ = false;
  std::int64_t left_bytes_ = 0;
  Utime given_ = kNever;  // newest tick
};

// The processes of a service in the order of their starts, with the release of the last message of each.
std::map<std::int64_t, Utime> boots_of(const RecordedLog& log, const std::string& service);

}  // namespace rover::replay
