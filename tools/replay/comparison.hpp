// What services say now against what they said when the log was recorded, byte by byte.
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

// One message as its header names it.
struct MessageName {
  std::string channel;
  std::string publisher;
  std::int64_t boot_id = 0;
  std::int64_t seq = 0;
  Utime utime = kNever;    // measurement
  Utime release = kNever;  // of the recorded one where there is one

  auto stream() const { return std::tie(channel, publisher); }
};

// The first difference of one stream.
struct Difference {
  enum class Kind { kContent, kMissingNow, kNotInLog };
  Kind kind = Kind::kContent;
  MessageName name;
  Bytes then;  // empty: not in the log
  Bytes now;   // empty: not said now
};

struct StreamVerdict {
  std::string channel;
  std::string publisher;
  std::int64_t identical = 0;  // messages, before the first difference
  std::optional<Difference> first;
};

class Comparison {
 public:
  // Either side first; a message that both have said is settled at once.
  void recorded(const MessageName& name, const Bytes& bytes) { take(name, bytes, true); }
  void said_now(const MessageName& name, const Bytes& bytes) { take(name, bytes, false); }

  // The verdicts by channel and publisher. What only one side has said counts where its release is not after `end`.
  std::vector<StreamVerdict> finish(Utime end);

 private:
  struct Waiting {
    MessageName name;
    Bytes bytes;
    bool recorded;
  };
  using Id = std::pair<std::int64_t, std::int64_t>;  // boot, seq
  struct Stream {
    std::int64_t identical = 0;
    std::optional<Difference> first;
    std::map<Id, Waiting> waiting;  // one side has said these
  };
  void take(const MessageName& name, const Bytes& bytes, bool recorded);
  static void settle(Stream& stream, const Waiting& one, const Waiting& other);

  std::map<std::pair<std::string, std::string>, Stream> streams_;
};

// The earliest by release, then by channel; nothing where all is alike.
std::optional<Difference> first_of(const std::vector<StreamVerdict>& verdicts);

}  // namespace rover::replay
