// Traffic statistics of a bus or a log, by channel. Wall time is an argument.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/core/frames.hpp"
#include "common/core/time.hpp"
#include "tools/status/message_clock.hpp"
#include "tools/status/stream_statistics.hpp"

namespace rover::spy {

struct ChannelStatistics {
  std::string type;  // empty: unknown channel
  std::vector<std::string> publishers;
  std::int64_t messages = 0;
  std::int64_t bytes = 0;
  double hz = kNaN;           // per second of message time
  double bytes_per_s = kNaN;  // bus: per second of wall time; log: per second of its length
  double age_s = kNaN;        // newest measurement relative to the newest TICK
  std::int64_t gaps = 0;      // missing sequence numbers
  std::int64_t malformed = 0;
  std::vector<std::uint8_t> newest;  // the last valid message
};

struct TrafficStatistics {
  Utime now = kNever;             // newest TICK
  double realtime_factor = kNaN;  // bus only
  double span_s = 0.0;            // wall time observed, or length of the log
  std::map<std::string, ChannelStatistics> channels;
};

// Statistics of the newest run. A TICK that goes back starts a new run.
class Traffic {
 public:
  // kRecent: rates over the last 5 s of message time. kWhole: over everything received.
  enum class Rates { kRecent, kWhole };
  explicit Traffic(Rates rates) : rates_(rates) {}

  // `wall_s` must not decrease; for a log it is the record's time.
  void add_message(const std::string& channel, const void* data, int size, double wall_s);
  TrafficStatistics statistics(double wall_s) const;

 private:
  struct Channel {
    std::map<std::string, status::StreamStatistics> streams;  // by publisher
    std::int64_t messages = 0;
    std::int64_t bytes = 0;
    std::int64_t malformed = 0;
    Utime newest_utime = kNever;
    std::vector<std::uint8_t> newest;
  };
  // Statistics of one run.
  struct Run {
    status::MessageClock clock;
    bool has_ticks = false;
    double first_wall_s = kNaN;
    std::map<std::string, Channel> channels;
  };
  void tick(Utime utime, double wall_s);
  void advance_by_wall_clock(double wall_s);
  void remove_before(Utime utime);
  ChannelStatistics statistics_of(const std::string& name, const Channel& channel, double wall_s) const;

  Rates rates_;
  Run run_;
};

}  // namespace rover::spy
