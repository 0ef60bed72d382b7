// The table of a bench: each run beside the paper's figures, medians, and whether each demand is met.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/core/frames.hpp"

namespace rover::report {

// One run's figures; NaN where a figure is not known.
struct BenchRow {
  std::string commit;
  std::string scenario;
  std::int64_t seed = 0;
  bool deterministic = false;
  std::string outcome;
  double planned_length_m = kNaN;
  double driven_length_m = kNaN;
  double path_ratio = kNaN;
  double replans = kNaN;
  double hazard_stops = kNaN;
  double collisions = kNaN;
  double rocks_missed = kNaN;
  double rocks_encountered = kNaN;
  double false_stops = kNaN;
  double faults = kNaN;  // rows of the table of faults that were raised
  double odometry_drift_percent = kNaN;
  double cross_track_rms_m = kNaN;
  double final_error_m = kNaN;
  double mean_speed_m_per_h = kNaN;
  double duty = kNaN;
  double realtime_factor = kNaN;
  double duration_s = kNaN;
  double point_turn_s = kNaN;
  std::map<std::string, double> time_in_state_s;
};

struct BenchContext {
  std::string suite;
  std::string command;
  std::string cpu_model;
  int cores = 0;
};

// Repairs below which a run that reached its goal says too little about rocks to count.
int least_repairs(const std::string& scenario);
bool counts(const BenchRow& row);
// NaN for none; the mean of the middle two for an even number.
double median(std::vector<double> values);

struct Gate {
  std::string demand;
  std::string measured;
  bool met = false;
};
std::vector<Gate> seed_gates(const std::vector<BenchRow>& rows);

// Of the newest commit among the rows (the last row's); a run given twice counts as last given.
std::vector<BenchRow> newest_rows(const std::vector<BenchRow>& rows);
std::string bench_table(const BenchContext& context, const std::vector<BenchRow>& rows);

}  // namespace rover::report
