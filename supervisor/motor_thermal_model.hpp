// First-order thermal model of a motor winding (i2t), driven by the squared current.
#pragma once

#include <algorithm>
#include <cmath>

#include "common/core/time.hpp"

namespace rover::supervisor {

class MotorThermalModel {
 public:
  // The load converges to 1 at the nominal current.
  MotorThermalModel(double nominal_a, double time_constant_s)
      : nominal_a_(nominal_a), time_constant_s_(time_constant_s) {}

  // Non-finite currents are ignored here; the current row raises on them.
  void add(double current_a, Utime utime) {
    const double dt_s = utime_ == kNever ? 0.0 : std::clamp(to_seconds(utime - utime_), 0.0, time_constant_s_);
    utime_ = utime;
    if (!std::isfinite(current_a)) return;
    const double ratio = std::min(std::abs(current_a) / nominal_a_, kMostRatio);
    const double square = ratio * ratio;
    load_ += (square - load_) * dt_s / time_constant_s_;
  }
  double load() const { return load_; }
  // After a restart: `load` was reached at `utime`.
  void restore(double load, Utime utime) {
    load_ = load;
    utime_ = utime;
  }

 private:
  static constexpr double kMostRatio = 100.0;  // no motor takes more; the load stays finite
  double nominal_a_;
  double time_constant_s_;
  double load_ = 0.0;
  Utime utime_ = kNever;
};

}  // namespace rover::supervisor
