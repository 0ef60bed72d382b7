// Reads a log as tick groups: each tick with the messages recorded before it.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <rover/header_t.hpp>
#include <string>
#include <vector>

#include "common/bus/log_runs.hpp"

namespace rover::replay {

struct LogMessage {
  std::string channel;
  std::optional<header_t> header;  // empty: header not decodable
  std::vector<std::uint8_t> bytes;
};

struct TickGroup {
  Utime tick = kNever;
  std::vector<LogMessage> messages;  // in recorded order, without TICK
  LogMessage tick_message;
};

// Statistics of one process's messages on one channel.
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
  // Scans all parts of the log (event_log.hpp); `log_run` selects a run if there are several (log_runs.hpp). Throws
  // ConfigError.
  explicit RecordedLog(const std::string& log_or_run, int log_run = 0);

  const LogRun& run() const { return run_; }
  const std::vector<Utime>& ticks() const { return ticks_; }
  const std::vector<RecordedStream>& streams() const { return streams_; }
  // True if ticks were paced by the wall clock; such a run is not reproducible.
  bool by_the_clock() const { return by_the_clock_; }
  // The first tick without a service that was a member before: it was killed, or stopped on demand.
  const std::map<std::string, Utime>& left() const { return left_; }
  // Messages in no group: after the last tick, or on channels whose names LCM cannot send.
  std::int64_t skipped_messages() const { return left_messages_; }

  // The group of the next tick; empty at the end.
  std::optional<TickGroup> next();
  // After this, next() returns the first tick at or after t.
  void seek(Utime t);

 private:
  // The next record from the current position; empty at the end of the run.
  std::optional<LogMessage> next_message();
  void open(const LogPlace& place);
  void scan();

  LogRun run_;
  std::vector<std::string> parts_;
  std::unique_ptr<EventLogReader> reader_;
  LogPlace place_;  // position after the last message read
  std::vector<Utime> ticks_;
  std::vector<LogPlace> places_;  // position of the first record after the previous tick
  std::vector<RecordedStream> streams_;
  std::map<std::string, Utime> left_;
  bool by_the_clock_ = false;
  std::int64_t left_messages_ = 0;
  Utime newest_tick_ = kNever;  // newest tick returned
};

// The processes of a service in start order, with the release time of each one's last message.
std::map<std::int64_t, Utime> boots_of(const RecordedLog& log, const std::string& service);

}  // namespace rover::replay
