#include "tools/status/stream_account.hpp"

#include <algorithm>

#include "common/core/frames.hpp"

namespace rover::status {

// A restarted publisher counts from 1 again: that is no gap.
void StreamAccount::begin(const Arrival& arrival) {
  old_gaps_ = gaps();
  boot_id_ = arrival.boot_id;
  first_seq_ = last_seq_ = arrival.seq;
  received_ = 0;
}

void StreamAccount::hear(const Arrival& arrival) {
  if (newest_ == kNever || arrival.boot_id > boot_id_) begin(arrival);
  if (arrival.boot_id < boot_id_) return;                  // the last words of one that died
  if (received_ > 0 && arrival.seq == last_seq_) return;   // a second copy
  if (arrival.seq < first_seq_) first_seq_ = arrival.seq;  // overtaken by the first that came
  last_seq_ = std::max(last_seq_, arrival.seq);
  ++received_;
  newest_ = std::max(newest_, arrival.utime);
  heard_.push_back(arrival);
  bytes_ += arrival.bytes;
}

void StreamAccount::forget_before(Utime utime) {
  while (!heard_.empty() && heard_.front().arrived < utime) {
    bytes_ -= heard_.front().bytes;
    heard_.pop_front();
  }
}

// A regular stream is measured by the spacing of its messages, which a short window does not round; one that comes on
// demand, or has stopped, by the number of those that came.
double StreamAccount::hz(const Window& window) const {
  if (window.message_s <= 0.0) return kNaN;
  const auto n = static_cast<double>(heard_.size());
  const double span_s = heard_.empty() ? 0.0 : to_seconds(heard_.back().utime - heard_.front().utime);
  const bool regular = heard_.size() >= 3 && span_s >= 0.6 * window.message_s;
  return regular ? (n - 1.0) / span_s : n / window.message_s;
}

}  // namespace rover::status
