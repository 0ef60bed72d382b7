// Result table of a benchmark: runs, the paper's figures, medians, and whether each requirement is met.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/core/frames.hpp"

namespace rover::report {

// Metrics of one run; NaN: unknown.
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
  double faults = kNaN;  // fault-table rows raised
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

// A successful run with fewer repairs met too few rocks to count.
int min_repairs(const std::string& scenario);
bool counts(const BenchRow& row);
// NaN for an empty list; the mean of the middle two for an even number.
double median(std::vector<double> values);

struct Gate {
  std::string requirement;
  std::string measured;
  bool met = false;
};
std::vector<Gate> seed_gates(const std::vector<BenchRow>& rows);

// Uses only rows with the commit of the last row; of rows with the same seed, the last one.
std::vector<BenchRow> newest_rows(const std::vector<BenchRow>& rows);
std::string bench_table(const BenchContext& context, const std::vector<BenchRow>& rows);

}  // namespace rover::report
