// Statistics of one publisher's messages on one channel: rate, volume, newest message, gaps.
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
  Utime utime = kNever;    // measurement time
  Utime arrived = kNever;  // newest tick at arrival
  size_t bytes = 0;
};

class StreamStatistics {
 public:
  void add(const Arrival& arrival);
  // Removes arrivals before utime.
  void remove_before(Utime utime);

  Utime newest() const { return newest_; }
  // Counted from the first message of each boot; a message that arrives out of order closes its gap.
  std::int64_t gaps() const { return previous_gaps_ + expected() - received_; }
  size_t count() const { return arrivals_.size(); }
  size_t bytes() const { return bytes_; }
  // Per second of message time.
  double hz(const Window& window) const;

 private:
  std::int64_t expected() const { return received_ == 0 ? 0 : last_seq_ - first_seq_ + 1; }
  void start_boot(const Arrival& arrival);

  std::deque<Arrival> arrivals_;
  size_t bytes_ = 0;
  Utime newest_ = kNever;
  std::int64_t boot_id_ = 0;
  std::int64_t first_seq_ = 0;
  std::int64_t last_seq_ = 0;
  std::int64_t received_ = 0;
  std::int64_t previous_gaps_ = 0;  // of previous boots
};

}  // namespace rover::status
