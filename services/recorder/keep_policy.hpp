// Selects the recorded events: all (full), or images only around triggers and every n-th (reduced).
#pragma once

#include <deque>
#include <set>
#include <string>

#include "recorder/event_buffer.hpp"

namespace rover::recorder {

struct KeepConfig {
  bool reduced = false;
  double images_before_s = 2.0;  // images kept before a trigger: five LocCam frames
  double images_after_s = 1.0;
  int image_interval = 50;  // also keep every n-th frame
  std::set<std::string> bulk_channels;
};

class KeepPolicy {
 public:
  explicit KeepPolicy(KeepConfig config);

  // Keeps the images around this time.
  void trigger(Utime time);
  bool keep(const Event& event) const;
  // Time that an event must be buffered so that keep() knows every relevant trigger.
  Utime delay() const { return config_.reduced ? before_ : 0; }

 private:
  KeepConfig config_;
  Utime before_;
  Utime after_;
  std::deque<Utime> triggers_;
};

}  // namespace rover::recorder
