// Result table of a benchmark: runs, the paper's figures, medians, and whether each requirement is met.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/core/frames.hpp"

namespace rover::report {

// Metrics of one run; NaN: unknown.
struct BenchRow {
  std::string commit;
  std::string command;  // that made the row
  std::string scenario;
  std::string level;
  std::int64_t seed = 0;
  bool deterministic = false;
  std::string outcome;
  double planned_length_m = kNaN;
  double driven_length_m = kNaN;
  double path_ratio = kNaN;
  double oracle_m = kNaN;
  double regret = kNaN;
  std::optional<bool> oracle_feasible;
  double progress = kNaN;
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
  double reverse_m = kNaN;
  double hazard_clearance_m = kNaN;
  std::map<std::string, double> seconds;  // by cause
  // Of POSE against the truth before the first correction, see pose_consistency.hpp.
  double anees_x = kNaN;
  double anees_y = kNaN;
  double anees_yaw = kNaN;
  double anees_xyyaw = kNaN;
};

struct BenchContext {
  std::string suite;
  std::string command;
  std::string cpu_model;
  int cores = 0;
};

// NaN for an empty list; the mean of the middle two for an even number.
double median(std::vector<double> values);

struct Gate {
  std::string requirement;
  std::string measured;
  bool met = false;
};
std::vector<Gate> seed_gates(const std::vector<BenchRow>& rows);
std::vector<Gate> success_gates(const std::vector<BenchRow>& rows);

// Of each level the rows with the commit of its last row; of rows with the same seed, the last one.
std::vector<BenchRow> newest_rows(const std::vector<BenchRow>& rows);

// Beside the paper's field test: the first ten valid runs of each traverse.
std::string bench_table(const BenchContext& context, const std::vector<BenchRow>& rows);
// How often the goal is reached on seeds that nobody selected, one section per level.
std::string success_table(const BenchContext& context, const std::vector<BenchRow>& rows);

// A benchmark of drives over seeds. `rows` of both functions: newest_rows().
struct BenchSuite {
  const char* name;
  std::string (*table)(const BenchContext& context, const std::vector<BenchRow>& rows);
  std::vector<Gate> (*gates)(const std::vector<BenchRow>& rows);
};
// Null if there is none of this name.
const BenchSuite* find_suite(const std::string& name);

}  // namespace rover::report
