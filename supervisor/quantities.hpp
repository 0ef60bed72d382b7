// Quantities that rows of config/fdir.yaml can monitor: name and reading function.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "supervisor/inputs.hpp"
#include "supervisor/monitor.hpp"

namespace rover::supervisor {

// Values derived from the inputs over time (DerivedValueTracker).
struct DerivedValues {
  std::array<double, 6> drive_i2t_load{};  // i2t load; 1: steady nominal current
  std::array<double, 4> steer_i2t_load{};
  double loss_ratio = 0.0;  // lost fraction of recent messages, over all services
  Utime lost_utime = kNever;
  std::map<std::string, int> restart_attempts;  // kills by the supervisor within the last minute
  std::map<std::string, int> starts;            // service starts within the last minute, without the first
  double clock_step_s = 0.0;                    // deviation of the last tick interval
  double unpermitted_s = 0.0;                   // duration of wheel motion without a permit
  double idle_s = 0.0;                          // duration of a permit without wheel motion
  double fault_stops = 0.0;                     // within the last fault_stop_distance_m
};

// Subject of an expanded row.
struct Subject {
  std::string service;
  int index = 0;  // motor index
};

// How a line of the table expands into rows.
enum class Expansion { kOne, kEachRequired, kEachOptional, kEachFull, kEachDrive, kEachSteer };

struct MonitorContext {
  const Inputs& inputs;
  const DerivedValues& derived;
  Utime utime;
  bool stationary;
  bool waiting_for_path;  // HAZARD_STOP or REPAIRING
  double stop_distance_m;
  double sweep_s;           // time since the sweep began, 0 if not sweeping
  bool backtracking;        // on a path back that recovers from a stop_backtrack fault
  double full_missing_s;    // time since path or ground require the Full level, and its services are not ready
  double keep_out_depth_m;  // how far the footprint reaches into a zone, now or where the rover can stop
};

struct Quantity {
  const char* name;
  Expansion expansion;
  Reading (*read)(const MonitorContext& context, const Subject& subject, double limit);
  bool of_computing = false;  // an age that a slower computer makes larger
};

std::span<const Quantity> quantities();
// Null if unknown.
const Quantity* find_quantity(const std::string& name);

inline constexpr std::array<const char*, 6> kDriveNames = {"FL", "FR", "ML", "MR", "RL", "RR"};
inline constexpr std::array<const char*, 4> kSteerNames = {"FL", "FR", "RL", "RR"};

}  // namespace rover::supervisor
