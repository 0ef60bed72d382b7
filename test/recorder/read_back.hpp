// Reads a log with LCM's own reader.
#pragma once

#include <lcm/eventlog.h>

#include <cstdint>
#include <string>
#include <vector>

namespace rover::recorder {

struct ReadBack {
  std::int64_t number;
  std::int64_t timestamp;
  std::string channel;
  std::vector<std::uint8_t> bytes;
};

inline std::vector<ReadBack> read_back(const std::string& path) {
  std::vector<ReadBack> events;
  lcm_eventlog_t* log = lcm_eventlog_create(path.c_str(), "r");
  if (log == nullptr) return events;
  while (lcm_eventlog_event_t* e = lcm_eventlog_read_next_event(log)) {
    const auto* data = static_cast<const std::uint8_t*>(e->data);
    events.push_back({e->eventnum, e->timestamp, std::string(e->channel, static_cast<size_t>(e->channellen)),
                      std::vector<std::uint8_t>(data, data + e->datalen)});
    lcm_eventlog_free_event(e);
  }
  lcm_eventlog_destroy(log);
  return events;
}

}  // namespace rover::recorder
