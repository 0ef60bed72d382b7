// Metrics of a run. NaN or empty optional: not applicable or unknown.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/report/map_fidelity.hpp"
#include "tools/report/pose_consistency.hpp"
#include "tools/report/rock_evaluation.hpp"
#include "tools/report/run_record.hpp"
#include "tools/report/stop_evaluation.hpp"
#include "tools/report/time_account.hpp"
#include "tools/report/track.hpp"
#include "tools/report/trajectory_error.hpp"
#include "tools/report/visual_consistency.hpp"

namespace rover::report {

struct LevelSwitch {
  double t_s = 0.0;
  bool to_full = false;
  std::string reason;
  double at_m = kNaN;    // driven distance at the switch
  std::string quantity;  // of the reason; empty: none
  double value = kNaN;
  double threshold = kNaN;
};

// Metrics of the time at one level of autonomy.
struct LevelFigures {
  double travelled_m = 0.0;
  double time_s = 0.0;
  int hazard_stops = 0;
};

struct CorrectionFigure {
  double t_s = 0.0;
  double before_m = kNaN;
  double after_m = kNaN;             // of the estimate after localization applied it
  double correction_error_m = kNaN;  // of the correction itself; NaN if rejected
  bool accepted = false;
  std::string reason;  // of the rejection; of a fix: what was matched
};

struct ServiceFigures {
  double cpu_s = 0.0;
  double cpu_s_per_m = kNaN;
  double cpu_s_per_m_efficient = kNaN;  // at that level
  double cpu_s_per_m_full = kNaN;
  double rss_mb = 0.0;  // maximum over the run, and over the first half of the drive
  double rss_first_half_mb = 0.0;
  int restarts = 0;
  double p50_ms = 0.0;
  double p99_ms = 0.0;
};

struct Metrics {
  RunInfo info;
  std::string outcome;
  Window window;
  std::vector<PathRecord> paths;  // followed; several: there is no planned length
  double planned_length_m = kNaN;
  double driven_length_m = kNaN;
  double path_ratio = kNaN;
  double oracle_m = kNaN;               // shortest drivable path on the true surface
  std::optional<bool> oracle_feasible;  // empty: unknown
  double regret = kNaN;                 // driven / oracle_m, of a drive that reached its goal
  double duration_s = kNaN;
  double progress = kNaN;  // planned (or its part made good) over top speed x time
  double duty = kNaN;      // driven over top speed x time
  TimeAccount time;
  double reverse_m = kNaN;
  double hazard_clearance_m = kNaN;  // of the wheels to a true hazard
  double mean_speed_m_per_h = kNaN;
  int hazard_stops = 0;
  int replans = 0;
  double replans_per_m = kNaN;
  std::vector<LevelSwitch> level_switches;
  LevelFigures efficient;
  LevelFigures full;
  int collisions = 0;
  double min_clearance_m = kNaN;
  double max_roll_deg = kNaN;
  double max_pitch_deg = kNaN;
  double rms_roll_deg = kNaN;
  double rms_pitch_deg = kNaN;
  double cross_track_rms_m = kNaN;
  double cross_track_max_m = kNaN;
  double truth_deviation_max_m = kNaN;
  double odometry_drift_percent = kNaN;
  double odometry_drift_max_m = kNaN;
  double slam_drift_percent = kNaN;      // from the first SLAM pose on
  double slam_odometry_ratio = kNaN;     // rms error of SLAM over that of odometry at the same poses
  double estimate_error_max_m = kNaN;    // of the pose in map
  double corrected_error_max_m = kNaN;   // the same, after the first accepted correction
  double final_error_m = kNaN;           // true final position to the goal
  double final_estimate_error_m = kNaN;  // estimated to true final position, in map
  PoseConsistency anees;                 // before the first accepted correction
  PoseConsistency anees_after_fix;
  MapFidelities map;
  std::vector<CorrectionFigure> global_corrections;
  std::optional<int> rocks_encountered;
  std::optional<int> rocks_detected;  // among those encountered
  std::optional<int> rocks_missed;
  std::optional<int> false_stops;
  int unobserved_stops = 0;
  std::vector<FaultRecord> fdir;         // each raised fault
  double motion_without_lease_s = kNaN;  // true motion after the permit expired, beyond the stopping time
  std::map<std::string, ServiceFigures> services;
  BusRecord bus;
  std::int64_t bus_lost = 0;  // counted by the receivers
  double realtime_factor = kNaN;
  std::optional<Eigen::Isometry3d> final_truth_pose;
  double mean_slip = kNaN;
  double mean_abs_current_a = kNaN;
  double max_current_a = kNaN;
  std::map<std::string, double> time_in_state_s;
  double point_turn_s = 0.0;
  int hazard_frames = 0;
  int hazard_frames_without_coverage = 0;
  double hazard_coverage_mean = kNaN;
  int vo_frames = 0;
  int vo_lost = 0;
  TrajectoryError visual_odometry;  // integrated VO motions
  TrajectoryError published_pose;   // POSE at the exposures
  VisualConsistency visual_consistency;
};

// Results used by metrics and pictures.
struct RunEvaluation {
  Metrics metrics;
  std::vector<RockResult> rocks;  // hazard rocks of the world
  std::vector<Incident> incidents;
  std::vector<Eigen::Vector2d> oracle_path;  // in map; empty: none, or not evaluated
};

// `world` empty: ground truth of the terrain unknown; rock metrics are null.
RunEvaluation evaluate(const RunRecord& run, const RunInfo& info, const Footprint& footprint,
                       const std::optional<TrueWorld>& world);

}  // namespace rover::report
