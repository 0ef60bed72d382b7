// The quantities that rows of config/fdir.yaml watch, by name: each says how it reads the inputs.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "supervisor/inputs.hpp"
#include "supervisor/monitor.hpp"

namespace rover::supervisor {

// What is computed from the inputs over time, beside them.
struct Derived {
  std::array<double, 6> drive_heat{};  // i2t load, 1 at the nominal current kept for ever
  std::array<double, 4> steer_heat{};
  double lost_share = 0.0;  // of the messages of the newest seconds, over all services
  Utime lost_utime = kNever;
  std::map<std::string, int> tries;   // of the supervisor to start the service anew, in the newest minute
  std::map<std::string, int> starts;  // of each service beyond its first, in the newest minute
  double clock_step_s = 0.0;          // between the newest two ticks
  double unpermitted_s = 0.0;         // wheels have turned for that long without a permit
  double idle_s = 0.0;                // the rover could have driven for that long and has not
  double fault_stops = 0.0;           // of the newest metres of way
};

// Whom an expanded row is about.
struct Subject {
  std::string service;
  int index = 0;  // motor
};

// Which rows one line of the table becomes.
enum class Expansion { kOne, kEachRequired, kEachOptional, kEachFull, kEachDrive, kEachSteer };

struct Now {
  const Inputs& in;
  const Derived& derived;
  Utime utime;
  bool standing_still;
  bool waits_before_block;  // in a state that waits for a way past a hazard
  double blocked_in_m;
  double stop_distance_m;
  double sweep_s;  // for how long the rover stands and sweeps
  bool way_back;   // its path is the remedy of stop_retreat, backwards over ground that it knows
};

struct Quantity {
  const char* name;
  Expansion expansion;
  Reading (*read)(const Now& now, const Subject& subject, double limit);
};

std::span<const Quantity> quantities();
// Null where there is none of that name.
const Quantity* find_quantity(const std::string& name);

inline constexpr std::array<const char*, 6> kDriveNames = {"FL", "FR", "ML", "MR", "RL", "RR"};
inline constexpr std::array<const char*, 4> kSteerNames = {"FL", "FR", "RL", "RR"};

}  // namespace rover::supervisor
