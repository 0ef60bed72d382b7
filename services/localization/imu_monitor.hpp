// Is the inertial unit alive? Silent, faulty and frozen are all dead: a real unit's noise never repeats.
#pragma once

#include "common/core/time.hpp"
#include "localization/inputs.hpp"

namespace rover::loc {

struct ImuMonitorConfig {
  double silence_s = 0.1;   // longer without a sound sample: dead
  int frozen_samples = 10;  // so many equal samples in a row: dead
};

class ImuMonitor {
 public:
  explicit ImuMonitor(const ImuMonitorConfig& config) : config_(config) {}

  // Tells whether the sample may be used.
  bool take(const ImuSample& sample);
  bool alive(Utime now) const;
  bool frozen() const { return repeats_ >= config_.frozen_samples; }

 private:
  ImuMonitorConfig config_;
  ImuSample last_;
  int repeats_ = 0;
  Utime last_good_utime_ = kNever;
};

}  // namespace rover::loc
