// Sorts messages by message time, so that two runs of one seed give the same log.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/core/time.hpp"

namespace rover::recorder {

struct Event {
  // Data sort before the tick that lists them, as a replay needs it.
  enum class Kind { kData = 0, kTick = 1 };

  Utime release = 0;
  Utime utime = 0;
  Kind kind = Kind::kData;
  std::string channel;
  std::string publisher;
  std::int64_t boot_id = 0;
  std::int64_t seq = 0;
  std::vector<std::uint8_t> bytes;
};

class EventBuffer {
 public:
  void add(Event event) { events_.push_back(std::move(event)); }
  // Removes and returns the events released before `until`, ordered by (release, kind, channel, publisher, boot, seq).
  std::vector<Event> pop_before(Utime until);
  std::vector<Event> pop_all();
  size_t size() const { return events_.size(); }

 private:
  std::vector<Event> events_;
};

}  // namespace rover::recorder
