// A log as replay takes it: tick by tick, each with the messages that belong before it.
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
  // Looks through the whole log, all parts of it (event_log.hpp); of one that holds several runs, `log_run` names one
  // (log_runs.hpp). Throws ConfigError with one line where there is no such run or it holds no ticks.
  explicit RecordedLog(const std::string& log_or_run, int log_run = 0);

  const LogRun& run() const { return run_; }
  const std::vector<Utime>& ticks() const { return ticks_; }
  const std::vector<RecordedStream>& streams() const { return streams_; }
  // Whether the ticks followed the clock: such a run is not repeated exactly.
  bool by_the_clock() const { return by_the_clock_; }
  // Messages that no group holds: behind the last tick, or on channels with names that LCM does not send.
  std::int64_t left_messages() const { return left_messages_; }

  // The group of the next tick; nothing at the end.
  std::optional<TickGroup> next();
  // next() then gives the first tick not before t.
  void seek(Utime t);

 private:
  // From the current place on; empty at the end of the run.
  std::optional<LogMessage> next_message();
  void open(const LogPlace& place);
  void look_through();

  LogRun run_;
  std::vector<std::string> parts_;
  std::unique_ptr<EventLogReader> reader_;
  LogPlace place_;  // behind the last message
  std::vector<Utime> ticks_;
  std::vector<LogPlace> places_;  // of the first record after the tick before
  std::vector<RecordedStream> streams_;
  bool by_the_clock_ = false;
  std::int64_t left_messages_ = 0;
  Utime given_ = kNever;  // newest tick
};

// The processes of a service in the order of their starts, with the release of the last message of each.
std::map<std::int64_t, Utime> boots_of(const RecordedLog& log, const std::string& service);

}  // namespace rover::replay
