// The figures of a run. NaN and empty optionals: not applicable or not known.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/report/rock_judge.hpp"
#include "tools/report/run_record.hpp"
#include "tools/report/stop_judge.hpp"
#include "tools/report/track.hpp"
#include "tools/report/trajectory_error.hpp"

namespace rover::report {

struct LevelSwitch {
  double t_s = 0.0;
  bool to_full = false;
  std::string reason;
  double at_m = kNaN;    // driven until then
  std::string quantity;  // behind the reason; empty: none
  double value = kNaN;
  double threshold = kNaN;
};

// What was driven at one level of autonomy.
struct LevelFigures {
  double way_m = 0.0;
  double time_s = 0.0;
  int hazard_stops = 0;
};

struct CorrectionFigure {
  double t_s = 0.0;
  double before_m = kNaN;
  double after_m = kNaN;  // of the estimate that localization made of it
  double fix_m = kNaN;    // of the fix alone; NaN for an abstention
  bool accepted = false;
  std::string reason;  // of an abstention
};

struct ServiceFigures {
  double cpu_s = 0.0;
  double cpu_s_per_m = kNaN;
  double cpu_s_per_m_efficient = kNaN;  // at that level
  double cpu_s_per_m_full = kNaN;
  double rss_mb = 0.0;  // largest, of the run and of the drive's first half
  double rss_first_half_mb = 0.0;
  int restarts = 0;
  double p50_ms = 0.0;
  double p99_ms = 0.0;
};

struct Metrics {
  RunInfo info;
  std::string outcome;
  Window window;
  double planned_length_m = kNaN;
  double driven_length_m = kNaN;
  double path_ratio = kNaN;
  double duration_s = kNaN;
  double duty = kNaN;
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
  double slam_drift_percent = kNaN;      // SLAM's own poses, the first of them on the truth
  double estimate_error_max_m = kNaN;    // of the pose in map
  double fixed_error_max_m = kNaN;       // the same since the first accepted correction
  double final_error_m = kNaN;           // true end of the drive against the goal
  double final_estimate_error_m = kNaN;  // estimated against true end of the drive, in map
  std::vector<CorrectionFigure> global_corrections;
  std::optional<int> rocks_encountered;
  std::optional<int> rocks_detected;  // of those encountered
  std::optional<int> rocks_missed;
  std::optional<int> false_stops;
  int unseen_stops = 0;
  std::vector<FaultRecord> fdir;         // each raised
  double motion_without_lease_s = kNaN;  // true motion later after the lease than a stop takes
  std::map<std::string, ServiceFigures> services;
  BusRecord bus;
  std::int64_t bus_lost = 0;  // as the receivers counted
  double realtime_factor = kNaN;
  std::optional<Eigen::Isometry3d> final_truth_pose;
  double mean_slip = kNaN;
  double mean_abs_current_a = kNaN;
  double max_current_a = kNaN;
  std::map<std::string, double> time_in_state_s;
  double point_turn_s = 0.0;
  int hazard_frames = 0;
  int hazard_frames_blind = 0;
  double hazard_coverage_mean = kNaN;
  int vo_frames = 0;
  int vo_lost = 0;
  TrajectoryError visual_odometry;  // its motions alone
  TrajectoryError published_pose;   // POSE at the exposures
};

// What the figures and the pictures share.
struct Judgement {
  Metrics metrics;
  std::vector<RockVerdict> rocks;  // hazard rocks of the world
  std::vector<Incident> incidents;
};

// `world` empty: the judge does not know the ground, and its rocks are null in the figures.
Judgement judge(const RunRecord& run, const RunInfo& info, const Footprint& footprint,
                const std::optional<TrueWorld>& world);

}  // namespace rover::report
