// When to look for the rover on the orbital map: after so much way since the map began, again after each fix, and
// sooner after an abstention.
#pragma once

namespace rover::global {

struct ScheduleConfig {
  double first_m = 10.0;
  double every_m = 20.0;
  double retry_m = 5.0;
};

class TrySchedule {
 public:
  explicit TrySchedule(const ScheduleConfig& config) : config_(config) {}

  // `travelled_m`: way driven since the start.
  bool due(double travelled_m) {
    if (!begun_) {
      begun_ = true;
      next_m_ = travelled_m + config_.first_m;
    }
    return travelled_m >= next_m_;
  }
  void tried(double travelled_m, bool accepted) {
    next_m_ = travelled_m + (accepted ? config_.every_m : config_.retry_m);
  }
  // The map begins anew.
  void restart() { begun_ = false; }

 private:
  ScheduleConfig config_;
  bool begun_ = false;
  double next_m_ = 0.0;
};

}  // namespace rover::global
