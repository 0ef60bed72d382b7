// Sums up what goes over a bus, or what a log holds, channel by channel. Knows no clock: wall time is an argument.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/core/frames.hpp"
#include "common/core/time.hpp"
#include "tools/status/message_clock.hpp"
#include "tools/status/stream_account.hpp"

namespace rover::spy {

struct ChannelFigures {
  std::string type;  // empty: a channel that the project does not know
  std::vector<std::string> publishers;
  std::int64_t messages = 0;
  std::int64_t bytes = 0;
  double hz = kNaN;           // per second of message time
  double bytes_per_s = kNaN;  // of a bus per second of wall time, of a log per second of it
  double age_s = kNaN;        // of the newest message against the newest TICK
  std::int64_t gaps = 0;      // missing by sequence number
  std::int64_t malformed = 0;
  std::vector<std::uint8_t> newest;  // the last whole message
};

struct Figures {
  Utime now = kNever;             // newest TICK
  double realtime_factor = kNaN;  // of a bus
  double span_s = 0.0;            // of wall time; of a log its length
  std::map<std::string, ChannelFigures> channels;
};

// Of the newest run: it begins where TICK falls.
class Traffic {
 public:
  // kRecent: rates over the last 5 s of message time. kWhole: over everything heard.
  enum class Rates { kRecent, kWhole };
  explicit Traffic(Rates rates) : rates_(rates) {}

  // A message, at a wall time that never falls; for a log, the record's time.
  void hear(const std::string& channel, const void* data, int size, double wall_s);
  Figures figures(double wall_s) const;

 private:
  struct Channel {
    std::map<std::string, status::StreamAccount> streams;  // by publisher
    std::int64_t messages = 0;
    std::int64_t bytes = 0;
    std::int64_t malformed = 0;
    Utime newest_utime = kNever;
    std::vector<std::uint8_t> newest;
  };
  // What was heard of one run; another one begins with accounts of its own.
  struct Run {
    status::MessageClock clock;
    bool has_ticks = false;
    double first_wall_s = kNaN;
    std::map<std::string, Channel> channels;
  };
  void tick(Utime utime, double wall_s);
  void tick_without_ticks(double wall_s);
  void forget_before(Utime utime);
  ChannelFigures figures_of(const std::string& name, const Channel& channel, double wall_s) const;

  Rates rates_;
  Run run_;
};

}  // namespace rover::spy
