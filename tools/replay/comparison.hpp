// Compares the messages of live services with those of the recorded log, byte by byte.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "common/core/time.hpp"

namespace rover::replay {

using Bytes = std::vector<std::uint8_t>;

// Header fields that identify a message.
struct MessageName {
  std::string channel;
  std::string publisher;
  std::int64_t boot_id = 0;
  std::int64_t seq = 0;
  Utime utime = kNever;    // measurement time
  Utime release = kNever;  // release time of the recorded message, else of the live one

  auto stream() const { return std::tie(channel, publisher); }
};

// First difference of one stream (channel and publisher).
struct Difference {
  enum class Kind { kContent, kMissingLive, kNotInLog };
  Kind kind = Kind::kContent;
  MessageName name;
  Bytes recorded;  // empty: not in the log
  Bytes live;      // empty: not published live
};

struct StreamComparison {
  std::string channel;
  std::string publisher;
  std::int64_t identical = 0;  // messages before the first difference
  std::optional<Difference> first;
};

class Comparison {
 public:
  // The two sides may arrive in any order; a message is compared when both are present.
  void add_recorded(const MessageName& name, const Bytes& bytes) { add(name, bytes, true); }
  void add_live(const MessageName& name, const Bytes& bytes) { add(name, bytes, false); }

  // Results by channel and publisher. Messages of one side alone are differences if released at or before `end`.
  std::vector<StreamComparison> finish(Utime end);

 private:
  struct Unmatched {
    MessageName name;
    Bytes bytes;
    bool recorded;
  };
  using Id = std::pair<std::int64_t, std::int64_t>;  // boot, seq
  struct Stream {
    std::int64_t identical = 0;
    std::optional<Difference> first;
    std::map<Id, Unmatched> unmatched;  // messages of one side that wait for the other
  };
  void add(const MessageName& name, const Bytes& bytes, bool recorded);
  static void compare(Stream& stream, const Unmatched& one, const Unmatched& other);

  std::map<std::pair<std::string, std::string>, Stream> streams_;
};

// The earliest by release time, then by channel; empty if all messages are identical.
std::optional<Difference> first_of(const std::vector<StreamComparison>& results);

}  // namespace rover::replay
