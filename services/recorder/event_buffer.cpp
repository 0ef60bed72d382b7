#include "recorder/event_buffer.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <tuple>

namespace rover::recorder {

std::vector<Event> EventBuffer::pop_before(Utime until) {
  const auto split = std::stable_partition(events_.begin(), events_.end(),
                                           [until](const Event& event) { return event.release >= until; });
  std::vector<Event> popped(std::make_move_iterator(split), std::make_move_iterator(events_.end()));
  events_.erase(split, events_.end());
  const auto key = [](const Event& e) { return std::tie(e.release, e.kind, e.channel, e.publisher, e.boot_id, e.seq); };
  std::stable_sort(popped.begin(), popped.end(), [&](const Event& a, const Event& b) { return key(a) < key(b); });
  return popped;
}

std::vector<Event> EventBuffer::pop_all() {
  return pop_before(std::numeric_limits<Utime>::max());
}

}  // namespace rover::recorder
