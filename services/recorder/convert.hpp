// Conversion of raw messages to recorder events.
#pragma once

#include "common/bus/node.hpp"
#include "recorder/event_buffer.hpp"

namespace rover::recorder {

Event event_from(const RawMessage& raw);

// Detects the triggers of reduced recording: a change of state, a repaired path, a fault.
class TriggerFinder {
 public:
  bool is_trigger(const RawMessage& raw);

 private:
  std::int8_t state_ = -1;
  std::int64_t path_id_ = -1;
};

}  // namespace rover::recorder
