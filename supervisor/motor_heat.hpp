// Thermal model of a motor's winding (i2t): first order, heated by the square of the current.
#pragma once

#include <algorithm>
#include <cmath>

#include "common/core/time.hpp"

namespace rover::supervisor {

class MotorHeat {
 public:
  // At the nominal current, kept for ever, the load settles at 1.
  MotorHeat(double nominal_a, double time_constant_s) : nominal_a_(nominal_a), time_constant_s_(time_constant_s) {}

  // A current that is no number heats nothing here: the row of the current itself raises on it.
  void add(double current_a, Utime utime) {
    const double dt_s = utime_ == kNever ? 0.0 : std::clamp(to_seconds(utime - utime_), 0.0, time_constant_s_);
    utime_ = utime;
    if (std::isnan(current_a)) return;
    const double square = current_a * current_a / (nominal_a_ * nominal_a_);
    load_ += (square - load_) * dt_s / time_constant_s_;
  }
  double load() const { return load_; }

 private:
  double nominal_a_;
  double time_constant_s_;
  double load_ = 0.0;
  Utime utime_ = kNever;
};

}  // namespace rover::supervisor
