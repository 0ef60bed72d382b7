#include "tools/status/stream_statistics.hpp"

#include <algorithm>

#include "common/core/frames.hpp"

namespace rover::status {

// A restarted publisher counts from 1 again: not a gap.
void StreamStatistics::start_boot(const Arrival& arrival) {
  previous_gaps_ = gaps();
  boot_id_ = arrival.boot_id;
  first_seq_ = last_seq_ = arrival.seq;
  received_ = 0;
}

void StreamStatistics::add(const Arrival& arrival) {
  if (newest_ == kNever || arrival.boot_id > boot_id_) start_boot(arrival);
  if (arrival.boot_id < boot_id_) return;                  // late message of the previous process
  if (received_ > 0 && arrival.seq == last_seq_) return;   // duplicate
  if (arrival.seq < first_seq_) first_seq_ = arrival.seq;  // arrived out of order
  last_seq_ = std::max(last_seq_, arrival.seq);
  ++received_;
  newest_ = std::max(newest_, arrival.utime);
  arrivals_.push_back(arrival);
  bytes_ += arrival.bytes;
}

void StreamStatistics::remove_before(Utime utime) {
  while (!arrivals_.empty() && arrivals_.front().arrived < utime) {
    bytes_ -= arrivals_.front().bytes;
    arrivals_.pop_front();
  }
}

// Periodic stream: rate from the message spacing, which does not depend on the window's ends. Otherwise: count /
// window.
double StreamStatistics::hz(const Window& window) const {
  if (window.message_s <= 0.0) return kNaN;
  const auto n = static_cast<double>(arrivals_.size());
  const double span_s = arrivals_.empty() ? 0.0 : to_seconds(arrivals_.back().utime - arrivals_.front().utime);
  const bool regular = arrivals_.size() >= 3 && span_s >= 0.6 * window.message_s;
  return regular ? (n - 1.0) / span_s : n / window.message_s;
}

}  // namespace rover::status
