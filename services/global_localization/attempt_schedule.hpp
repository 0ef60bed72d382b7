// Schedules correction attempts by distance driven: after the first map, after a fix, sooner after a rejection.
#pragma once

#include "common/core/frames.hpp"

namespace rover::global {

struct ScheduleConfig {
  double first_interval_m = 10.0;
  double interval_m = 20.0;
  double retry_interval_m = 5.0;
};

class AttemptSchedule {
 public:
  explicit AttemptSchedule(const ScheduleConfig& config) : config_(config) {}

  // `travelled_m`: total distance driven.
  bool due(double travelled_m) {
    if (!started_) {
      started_ = true;
      next_m_ = travelled_m + config_.first_interval_m;
    }
    return travelled_m >= next_m_;
  }
  void record_attempt(double travelled_m, bool accepted) {
    if (accepted) fix_m_ = travelled_m;
    next_m_ = travelled_m + (accepted ? config_.interval_m : config_.retry_interval_m);
  }
  // Distance driven since the last fix; infinity: none in the local map.
  double since_fix_m(double travelled_m) const { return travelled_m - fix_m_; }
  // The local map was cleared.
  void restart() {
    started_ = false;
    fix_m_ = -kInfinity;
  }

 private:
  ScheduleConfig config_;
  bool started_ = false;
  double next_m_ = 0.0;
  double fix_m_ = -kInfinity;
};

}  // namespace rover::global
