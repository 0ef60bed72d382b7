// What goes into the log: everything (full), or images only around events and now and then (reduced).
#pragma once

#include <deque>
#include <set>
#include <string>

#include "recorder/event_buffer.hpp"

namespace rover::recorder {

struct KeepConfig {
  bool reduced = false;
  double before_s = 2.0;  // of images kept before an event: five LocCam frames
  double after_s = 1.0;
  int every = 50;  // and each so many-th frame wherever it is
  std::set<std::string> bulk_channels;
};

class KeepPolicy {
 public:
  explicit KeepPolicy(KeepConfig config);

  // Something happened: the images around this time are of interest.
  void trigger(Utime time);
  bool keep(const Event& event) const;
  // How long an event must wait until keep() knows of every trigger that concerns it.
  Utime hold() const { return config_.reduced ? before_ : 0; }

 private:
  KeepConfig config_;
  Utime before_;
  Utime after_;
  std::deque<Utime> triggers_;
};

}  // namespace rover::recorder
