#include "test/bench_faults/judge/deliveries.hpp"

#include <algorithm>
#include <limits>

#include "common/bus/field_faults.hpp"
#include "common/core/check.hpp"

namespace rover::bench_faults {
namespace {

bool is_for(const injection_t& injection, const Delivery& delivery) {
  const std::string channel = split_field(injection.target).channel;
  return (channel == "*" || channel == delivery.channel) && delivery.header.utime >= injection.from_utime &&
         delivery.header.utime <= injection.until_utime;
}

}  // namespace

void Deliveries::inject(const injection_t& injection) {
  std::erase_if(injections_,
                [&](const injection_t& old) { return old.until_utime + 10'000'000 < injection.from_utime; });
  injections_.push_back(injection);
}

void Deliveries::sent(Delivery delivery) {
  waiting_.push_back({delivery.header.release_utime, std::move(delivery)});
}

std::vector<Delivery> Deliveries::take(Utime tick) {
  const auto later = std::stable_partition(waiting_.begin(), waiting_.end(),
                                           [tick](const Waiting& waiting) { return waiting.at <= tick; });
  std::vector<Waiting> due(std::make_move_iterator(waiting_.begin()), std::make_move_iterator(later));
  waiting_.erase(waiting_.begin(), later);
  std::stable_sort(due.begin(), due.end(), [](const Waiting& a, const Waiting& b) {
    const auto key = [](const Waiting& w) {
      const header_t& h = w.delivery.header;
      return std::tie(w.at, w.delivery.channel, h.publisher, h.boot_id, h.seq);
    };
    return key(a) < key(b);
  });
  std::vector<Delivery> out;
  for (Waiting& waiting : due) {
    Delivery& d = waiting.delivery;
    Utime delay = 0;
    bool lost = false;
    // Faults are not applied twice to a message.
    for (const injection_t& injection : injections_) {
      if (waiting.at > d.header.release_utime || !is_for(injection, d)) continue;
      if (injection.fault == "drop") {
        lost = injection.amount == 1.0;  // partial losses of a dense stream cause no age fault; receivers count them
      } else if (injection.fault == "delay") {
        delay += to_utime(injection.amount);
      } else if (injection.fault == "nan" || injection.fault == "offset") {
        const bool nan = injection.fault == "nan";
        const auto change = [&](double value) {
          return nan ? std::numeric_limits<double>::quiet_NaN() : value + injection.amount;
        };
        d.bytes = change_fields(split_field(injection.target), change, std::move(d.bytes));
      } else {
        ROVER_CHECK(injection.fault == "duplicate", injection.fault);  // changes only the receivers' counters
      }
    }
    if (lost) continue;
    if (delay > 0) {
      waiting_.push_back({waiting.at + delay, std::move(d)});
      continue;
    }
    auto& newest = newest_[{d.channel, d.header.publisher}];
    const std::pair<std::int64_t, std::int64_t> order{d.header.boot_id, d.header.seq};
    if (order <= newest) continue;
    newest = order;
    out.push_back(std::move(d));
  }
  return out;
}

}  // namespace rover::bench_faults
