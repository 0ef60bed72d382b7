// IMU health: silent, faulty and frozen units are unhealthy. The noise of a working unit never repeats.
#pragma once

#include "common/core/time.hpp"
#include "localization/inputs.hpp"

namespace rover::loc {

struct ImuMonitorConfig {
  double timeout_s = 0.1;   // unhealthy after this long without a valid sample
  int frozen_samples = 10;  // unhealthy after this many identical samples in a row
};

class ImuMonitor {
 public:
  explicit ImuMonitor(const ImuMonitorConfig& config) : config_(config) {}

  // True if the sample may be used.
  bool add(const ImuSample& sample);
  bool healthy(Utime now) const;
  bool frozen() const { return repeats_ >= config_.frozen_samples; }

 private:
  ImuMonitorConfig config_;
  ImuSample last_;
  int repeats_ = 0;
  Utime last_valid_utime_ = kNever;
};

}  // namespace rover::loc
