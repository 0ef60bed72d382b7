// Seconds of the drive by cause, and distance in reverse.
#pragma once

#include <array>

#include "tools/report/track.hpp"

namespace rover::report {

enum class TimeCause {
  kStraight,
  kCurve,
  kPointTurn,
  kSteering,
  kReverse,
  kWaitingForPlan,
  kHazardStop,
  kSweep,
  kBlind,
  kFault,
  kOther
};
inline constexpr int kTimeCauses = 11;

const char* key_of(TimeCause cause);    // in metrics.json
const char* title_of(TimeCause cause);  // in the report

// One cause at each instant: the seconds add up to the length of the window.
struct TimeAccount {
  std::array<double, kTimeCauses> seconds{};
  double of(TimeCause cause) const { return seconds[static_cast<size_t>(cause)]; }
};

// README.md defines the causes.
TimeCause cause_at(const RunRecord& run, const VehicleWheels& wheels, double t_s);
TimeAccount account_time(const RunRecord& run, const VehicleWheels& wheels, const Window& window);

// True motion against the heading; steps below 2 cm are ignored (vibration). NaN without TRUTH.
double reverse_distance_m(const RunRecord& run, const Window& window);

}  // namespace rover::report
