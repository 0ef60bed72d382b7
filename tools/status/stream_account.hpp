// One publisher's messages on one channel: rate, volume, newest, and what is missing by sequence number.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

#include "common/core/time.hpp"
#include "tools/status/message_clock.hpp"

namespace rover::status {

struct Arrival {
  std::int64_t boot_id = 0;
  std::int64_t seq = 0;
  Utime utime = kNever;    // of the measurement
  Utime arrived = kNever;  // newest tick at the arrival
  size_t bytes = 0;
};

class StreamAccount {
 public:
  void hear(const Arrival& arrival);
  // Forgets what arrived before.
  void forget_before(Utime utime);

  Utime newest() const { return newest_; }
  // Counted from the first message heard of each boot; one overtaken on the bus fills its gap when it comes.
  std::int64_t gaps() const { return old_gaps_ + expected() - received_; }
  size_t count() const { return heard_.size(); }
  size_t bytes() const { return bytes_; }
  // Per second of message time.
  double hz(const Window& window) const;

 private:
  std::int64_t expected() const { return received_ == 0 ? 0 : last_seq_ - first_seq_ + 1; }
  void begin(const Arrival& arrival);

  std::deque<Arrival> heard_;
  size_t bytes_ = 0;
  Utime newest_ = kNever;
  std::int64_t boot_id_ = 0;
  std::int64_t first_seq_ = 0;
  std::int64_t last_seq_ = 0;
  std::int64_t received_ = 0;
  std::int64_t old_gaps_ = 0;  // of the boots before
};

}  // namespace rover::status
