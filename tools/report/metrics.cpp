#include "tools/report/metrics.hpp"

#include <algorithm>
#include <cmath>

#include "tools/report/wheel_clearance.hpp"

namespace rover::report {
namespace {

constexpr double kCollisionPauseS = 1.0;   // contacts closer in time count as one collision
constexpr double kCorrectionDelayS = 0.1;  // time after release by which localization has applied a correction

class Spread {
 public:
  void add(double value) {
    if (!std::isfinite(value)) return;
    ++count_;
    sum_ += value;
    sum2_ += value * value;
    max_abs_ = std::max(max_abs_, std::abs(value));
  }
  double mean() const { return count_ > 0 ? sum_ / count_ : kNaN; }
  double rms() const { return count_ > 0 ? std::sqrt(sum2_ / count_) : kNaN; }
  double max_abs() const { return count_ > 0 ? max_abs_ : kNaN; }

 private:
  int count_ = 0;
  double sum_ = 0.0;
  double sum2_ = 0.0;
  double max_abs_ = 0.0;
};

double rounded(double seconds) {
  return std::round(seconds * 1e6) / 1e6;
}

bool goal_reached(const RunRecord& run) {
  return std::any_of(run.states.begin(), run.states.end(),
                     [](const StateChange& change) { return change.state == State::kGoalReached; });
}

std::string outcome_of(const RunRecord& run, const Metrics& m) {
  if (m.collisions > 0) return "collision";
  if (goal_reached(run)) return "goal_reached";
  const bool reported = !m.info.outcome_hint.empty() && m.info.outcome_hint != "goal_reached";
  // How the drive ended is not in the log.
  if (run.bus.missing_end_s > 0.0) return reported ? m.info.outcome_hint : "stopped";
  if (!run.planner.empty() && run.planner.back().no_path) return "no_path";
  if (!run.states.empty()) {
    const State last = run.states.back().state;
    if (last == State::kFaultStop || last == State::kSafe) return "fault_stop";
  }
  return reported ? m.info.outcome_hint : "timeout";
}

void evaluate_length(const TrueTrack& truth, const Footprint& footprint, Metrics& m) {
  if (m.paths.size() == 1) m.planned_length_m = length_m(m.paths.front().points);
  m.duration_s = rounded(m.window.end_s - m.window.begin_s);
  if (!truth.empty()) m.driven_length_m = truth.distance_m(m.window.end_s) - truth.distance_m(m.window.begin_s);
  if (m.planned_length_m > 0.0) m.path_ratio = m.driven_length_m / m.planned_length_m;
  if (m.duration_s > 0.0) {
    m.duty = m.driven_length_m / (footprint.top_speed_mps * m.duration_s);
    m.mean_speed_m_per_h = m.driven_length_m / m.duration_s * 3600.0;
  }
}

// The rover's place, to which paths and the goal refer: its ground point.
Eigen::Vector2d place_at(const TrueTrack& truth, const Footprint& footprint, double t_s) {
  return ground_pose(truth.at(t_s), footprint.origin_height_m).translation().head<2>();
}

// The planned length up to where the drive ended: all of it at the goal.
double made_good_m(const RunRecord& run, const TrueTrack& truth, const Footprint& footprint, const Metrics& m) {
  if (goal_reached(run)) return m.planned_length_m;
  if (truth.empty() || m.paths.size() != 1) return kNaN;
  const Points& planned = m.paths.front().points;
  return m.planned_length_m - length_m(part_ahead(planned, place_at(truth, footprint, m.window.end_s), kInfinity));
}

void evaluate_time(const RunRecord& run, const TrueTrack& truth, const Footprint& footprint, Metrics& m) {
  if (m.duration_s > 0.0) m.progress = made_good_m(run, truth, footprint, m) / (footprint.top_speed_mps * m.duration_s);
  m.time = account_time(run, footprint.wheels, m.window);
  m.reverse_m = reverse_distance_m(run, m.window);
}

void evaluate_truth(const RunRecord& run, Metrics& m) {
  Spread roll;
  Spread pitch;
  Spread slip;
  double last_contact = -kInfinity;
  for (const TruthSample& sample : run.truth) {
    if (sample.t_s > m.window.end_s) break;
    if (sample.collision) {
      if (sample.t_s - last_contact > kCollisionPauseS) ++m.collisions;
      last_contact = sample.t_s;
    }
    m.final_truth_pose = sample.T_map_body;
    if (sample.t_s < m.window.begin_s) continue;
    const Eigen::Vector3d rpy = rpy_of(sample.T_map_body.linear());
    roll.add(to_deg(rpy.x()));
    pitch.add(to_deg(rpy.y()));
    slip.add(sample.wheel_slip);
    if (std::isfinite(sample.clearance_m)) m.min_clearance_m = std::fmin(m.min_clearance_m, sample.clearance_m);
  }
  m.max_roll_deg = roll.max_abs();
  m.max_pitch_deg = pitch.max_abs();
  m.rms_roll_deg = roll.rms();
  m.rms_pitch_deg = pitch.rms();
  m.mean_slip = slip.mean();
}

void evaluate_control(const RunRecord& run, Metrics& m) {
  Spread cross_track;
  for (size_t i = 0; i < run.control.size(); ++i) {
    const ControlSample& sample = run.control[i];
    if (!m.window.contains(sample.t_s)) continue;
    if (sample.following == Following::kFollowing) cross_track.add(sample.cross_track_m);
    if (sample.following == Following::kPointTurn && i + 1 < run.control.size())
      m.point_turn_s += run.control[i + 1].t_s - sample.t_s;
  }
  m.point_turn_s = rounded(m.point_turn_s);
  m.cross_track_rms_m = cross_track.rms();
  m.cross_track_max_m = cross_track.max_abs();
}

// True position relative to the followed path where the rover believes it to be, in map: includes drift.
// Over the whole log: the rover must not move without a permit before and after the drive either.
void evaluate_lease(const RunRecord& run, Metrics& m) {
  constexpr double kStopS = 3.0;  // stop from top speed at maximum deceleration, plus command latency
  constexpr double kMovingMps = 0.03;
  if (run.truth.empty() || m.info.data_set_pairs) return;
  m.motion_without_lease_s = 0.0;
  double lease_s = -kInfinity;
  double before_s = run.truth.front().t_s;
  auto permit = run.permits.begin();
  for (const TruthSample& sample : run.truth) {
    for (; permit != run.permits.end() && permit->released_s <= sample.t_s; ++permit)
      lease_s = std::max(lease_s, permit->until_s);
    if (sample.speed_mps > kMovingMps && sample.t_s - lease_s > kStopS)
      m.motion_without_lease_s += sample.t_s - before_s;
    before_s = sample.t_s;
  }
}

void evaluate_deviation(const RunRecord& run, const TrueTrack& truth, const Footprint& footprint, Metrics& m) {
  constexpr double kStepS = 0.2;
  double next = m.window.begin_s;
  for (const ControlSample& control : run.control) {
    if (!m.window.contains(control.t_s) || control.following != Following::kFollowing || control.t_s < next) continue;
    next = control.t_s + kStepS;
    const PoseSample* pose = newest(run.poses, control.t_s);
    if (pose == nullptr || truth.empty()) continue;
    const auto followed = [&](const PathRecord& path) { return path.id == control.path_id && path.t_s <= control.t_s; };
    auto path = std::find_if(run.local_paths.rbegin(), run.local_paths.rend(), followed);
    if (path == run.local_paths.rend()) {
      path = std::find_if(run.global_paths.rbegin(), run.global_paths.rend(), followed);
      if (path == run.global_paths.rend()) continue;
    }
    Eigen::Vector2d p = place_at(truth, footprint, control.t_s);
    if (path->in_odom) p = transform(inverse(planar(pose->T_map_odom)), p);
    m.truth_deviation_max_m = std::fmax(m.truth_deviation_max_m, distance_m(path->points, p));
  }
}

void evaluate_drift(const RunRecord& run, const TrueTrack& truth, Metrics& m) {
  const std::vector<DriftSample> drift = odometry_drift(run, truth, m.window);
  if (drift.empty()) return;
  for (const DriftSample& sample : drift)
    m.odometry_drift_max_m = std::fmax(m.odometry_drift_max_m, std::hypot(sample.error_x_m, sample.error_y_m));
  const auto percent = [&m](double error) {
    return m.driven_length_m > 0.0 ? 100.0 * error / m.driven_length_m : kNaN;
  };
  m.odometry_drift_percent = percent(std::hypot(drift.back().error_x_m, drift.back().error_y_m));
  const PoseSample* end = newest(run.poses, m.window.end_s);
  const Eigen::Isometry3d T_map_body = end->T_map_odom * end->T_odom_body;
  m.final_estimate_error_m = (T_map_body.translation() - truth.at(end->t_s).translation()).head<2>().norm();
}

double sum_of_squares_m2(const std::vector<DriftSample>& errors) {
  double sum = 0.0;
  for (const DriftSample& e : errors) sum += e.error_x_m * e.error_x_m + e.error_y_m * e.error_y_m;
  return sum;
}

// Distance since the first SLAM pose, which may come in the middle of the drive.
void evaluate_slam(const RunRecord& run, const TrueTrack& truth, Metrics& m) {
  const SlamTrack slam = slam_track(run, truth, m.window);
  if (slam.drift.size() < 2) return;
  const DriftSample& end = slam.drift.back();
  const double travelled_m = end.distance_m - slam.drift.front().distance_m;
  if (travelled_m > 0.0) m.slam_drift_percent = 100.0 * std::hypot(end.error_x_m, end.error_y_m) / travelled_m;
  const double odometry_m2 = sum_of_squares_m2(slam.odometry);
  if (odometry_m2 > 0.0) m.slam_odometry_ratio = std::sqrt(sum_of_squares_m2(slam.drift) / odometry_m2);
}

void evaluate_estimate(const RunRecord& run, const TrueTrack& truth, Metrics& m) {
  if (truth.empty()) return;
  const double fixed_s = first_fix_s(run);
  m.anees = pose_consistency(run, truth, {m.window.begin_s, std::min(m.window.end_s, fixed_s)});
  m.anees_after_fix = pose_consistency(run, truth, {fixed_s, m.window.end_s});
  for (const PoseSample& pose : run.poses) {
    if (!m.window.contains(pose.t_s)) continue;
    const Eigen::Vector3d p = (pose.T_map_odom * pose.T_odom_body).translation();
    const double error_m = (p - truth.at(pose.t_s).translation()).head<2>().norm();
    m.estimate_error_max_m = std::fmax(m.estimate_error_max_m, error_m);
    if (pose.t_s >= fixed_s) m.corrected_error_max_m = std::fmax(m.corrected_error_max_m, error_m);
  }
}

void evaluate_goal(const TrueTrack& truth, const Footprint& footprint, Metrics& m) {
  if (m.paths.empty() || m.paths.back().points.empty() || truth.empty()) return;
  m.final_error_m = (m.paths.back().points.back() - place_at(truth, footprint, m.window.end_s)).norm();
}

// Within the drive.
double driven_at(const TrueTrack& truth, const Window& window, double t_s) {
  if (truth.empty()) return 0.0;
  return truth.distance_m(std::clamp(t_s, window.begin_s, window.end_s)) - truth.distance_m(window.begin_s);
}

void evaluate_states(const RunRecord& run, const TrueTrack& truth, Metrics& m) {
  for (size_t i = 0; i < run.states.size(); ++i) {
    const StateChange& change = run.states[i];
    const bool first = i == 0;
    LevelFigures& level = change.full ? m.full : m.efficient;
    if (hazard_stop_begins(run, i) && m.window.contains(change.t_s)) {
      ++m.hazard_stops;
      ++level.hazard_stops;
    }
    if (!first && change.full != run.states[i - 1].full)
      m.level_switches.push_back({change.t_s, change.full, change.cause, driven_at(truth, m.window, change.t_s),
                                  change.quantity, change.value, change.threshold});
    const double until = i + 1 < run.states.size() ? run.states[i + 1].t_s : m.window.end_s;
    const double spent = std::min(until, m.window.end_s) - std::max(change.t_s, m.window.begin_s);
    if (!(spent > 0.0)) continue;
    m.time_in_state_s[state_name(change.state)] += rounded(spent);
    level.time_s += rounded(spent);
    level.travelled_m += driven_at(truth, m.window, until) - driven_at(truth, m.window, change.t_s);
  }
  if (m.driven_length_m > 0.0) m.replans_per_m = m.replans / m.driven_length_m;
}

// A restarted planner counts from zero.
int count_replans(const RunRecord& run, const Window& window) {
  int total = 0;
  int last = 0;
  for (const PlannerSample& sample : run.planner) {
    if (sample.t_s > window.end_s) break;
    total += sample.replans >= last ? sample.replans - last : sample.replans;
    last = sample.replans;
  }
  return total;
}

void evaluate_corrections(const RunRecord& run, const TrueTrack& truth, Metrics& m) {
  for (const CorrectionRecord& correction : run.corrections) {
    CorrectionFigure figure{.t_s = correction.t_s, .accepted = correction.accepted, .reason = correction.reason};
    const PoseSample* pose = newest(run.poses, correction.t_s);
    if (pose != nullptr && !truth.empty()) {
      const Eigen::Vector2d p = truth.at(pose->t_s).translation().head<2>();
      const auto error_m = [&](const Eigen::Isometry3d& T_map_odom) {
        return ((T_map_odom * pose->T_odom_body).translation().head<2>() - p).norm();
      };
      const Eigen::Vector2d in_odom = pose->T_odom_body.translation().head<2>();
      figure.before_m = figure.after_m = error_m(pose->T_map_odom);
      if (correction.accepted) {
        // In a damaged log the release may precede the map or all poses.
        const double taken_s = std::max(correction.t_s, correction.released_s + kCorrectionDelayS);
        figure.after_m = error_m(newest(run.poses, taken_s)->T_map_odom);
        figure.correction_error_m = (transform(correction.T_map_odom, in_odom) - p).norm();
      }
    }
    m.global_corrections.push_back(figure);
  }
}

// CPU time between two heartbeats counts for the level at the second one.
void evaluate_cpu_by_level(const RunRecord& run, const ServiceRecord& record, const Metrics& m,
                           ServiceFigures& figures) {
  double efficient_s = 0.0;
  double full_s = 0.0;
  const HeartbeatSample* before = nullptr;
  for (const HeartbeatSample& sample : record.heartbeats) {
    const bool goes_on = before != nullptr && before->boot_id == sample.boot_id;
    if (goes_on && m.window.contains(sample.t_s)) {
      const StateChange* state = newest(run.states, sample.t_s);
      (state != nullptr && state->full ? full_s : efficient_s) += sample.cpu_s - before->cpu_s;
    }
    before = &sample;
  }
  constexpr double kMinDistanceM = 1.0;
  if (m.efficient.travelled_m > kMinDistanceM) figures.cpu_s_per_m_efficient = efficient_s / m.efficient.travelled_m;
  if (m.full.travelled_m > kMinDistanceM) figures.cpu_s_per_m_full = full_s / m.full.travelled_m;
}

// Maximum over the run, and over the first half of the drive: the difference shows a leak.
void evaluate_memory(const ServiceRecord& record, const Window& window, ServiceFigures& figures) {
  const double half_s = 0.5 * (window.begin_s + window.end_s);
  for (const HeartbeatSample& sample : record.heartbeats) {
    figures.rss_mb = std::max(figures.rss_mb, sample.rss_mb);
    if (sample.t_s <= half_s) figures.rss_first_half_mb = std::max(figures.rss_first_half_mb, sample.rss_mb);
  }
}

void evaluate_services(const RunRecord& run, Metrics& m) {
  // In one process each heartbeat states the time and memory of all services.
  if (m.info.perception == "geometric" || m.info.perception == "truth") return;
  for (const auto& [name, record] : run.services) {
    ServiceFigures figures;
    for (const auto& [boot, cpu_s] : record.cpu_s_of_boot) figures.cpu_s += cpu_s;
    if (m.driven_length_m > 0.0) figures.cpu_s_per_m = figures.cpu_s / m.driven_length_m;
    evaluate_cpu_by_level(run, record, m, figures);
    evaluate_memory(record, m.window, figures);
    figures.p50_ms = record.p50_ms;
    figures.p99_ms = record.p99_ms;
    figures.restarts = std::max(0, static_cast<int>(record.cpu_s_of_boot.size()) - 1 - record.starts_on_demand);
    m.services[name] = figures;
    for (const auto& [input, gaps] : record.gaps) m.bus_lost += gaps;
  }
  for (const auto& [name, restarts] : m.info.restarts) {
    ServiceFigures& figures = m.services[name];
    figures.restarts = std::max(figures.restarts, restarts);
  }
}

void evaluate_sensing(const RunRecord& run, Metrics& m) {
  Spread coverage;
  for (const HazardMap& map : run.hazards) {
    if (!m.window.contains(map.t_s)) continue;
    ++m.hazard_frames;
    m.hazard_frames_without_coverage += map.blind ? 1 : 0;
    coverage.add(map.coverage);
  }
  m.hazard_coverage_mean = coverage.mean();
  m.vo_frames = static_cast<int>(run.visual.size());
  m.vo_lost = static_cast<int>(
      std::count_if(run.visual.begin(), run.visual.end(), [](const VisualSample& motion) { return motion.lost; }));
  Spread current;
  for (const WheelSample& sample : run.wheels)
    if (m.window.contains(sample.t_s))
      for (const double a : sample.current_a) current.add(std::abs(a));
  m.mean_abs_current_a = current.mean();
  m.max_current_a = current.max_abs();
}

void evaluate_world(const RunRecord& run, const TrueTrack& truth, const Footprint& footprint, const TrueWorld& world,
                    RunEvaluation& evaluation) {
  Metrics& m = evaluation.metrics;
  evaluation.rocks = evaluate_rocks(run, truth, m.window, footprint, world.rocks);
  m.rocks_encountered = m.rocks_detected = m.rocks_missed = m.false_stops = 0;
  for (const RockResult& result : evaluation.rocks) {
    *m.rocks_encountered += result.encountered ? 1 : 0;
    *m.rocks_detected += result.encountered && result.detected_s < kInfinity ? 1 : 0;
    *m.rocks_missed += result.missed() ? 1 : 0;
  }
  for (const Incident& incident : evaluation.incidents) *m.false_stops += incident.is_false() ? 1 : 0;
  m.map = map_fidelities(run, truth, m.window, footprint, world);
  m.hazard_clearance_m = hazard_clearance_m(run, m.window, footprint.wheels, footprint.origin_height_m, world);
}

}  // namespace

RunEvaluation evaluate(const RunRecord& run, const RunInfo& info, const Footprint& footprint,
                       const std::optional<TrueWorld>& world) {
  RunEvaluation evaluation;
  Metrics& m = evaluation.metrics;
  m.info = info;
  m.window = drive_window(run);
  const TrueTrack truth(run.truth);
  m.paths = followed_paths(run, m.window);
  evaluate_length(truth, footprint, m);
  evaluate_time(run, truth, footprint, m);
  evaluate_truth(run, m);
  evaluate_lease(run, m);
  evaluate_control(run, m);
  evaluate_deviation(run, truth, footprint, m);
  evaluate_drift(run, truth, m);
  evaluate_slam(run, truth, m);
  evaluate_estimate(run, truth, m);
  evaluate_goal(truth, footprint, m);
  const std::vector<PosePair> odometry = visual_poses(run, truth);
  const SegmentRule rule = segment_rule(trajectory_length_m(odometry));
  m.visual_odometry = trajectory_error(odometry, rule);
  m.published_pose = trajectory_error(published_poses(run, truth), rule);
  m.visual_consistency = visual_consistency(run, truth);
  m.replans = count_replans(run, m.window);
  evaluate_states(run, truth, m);
  evaluate_corrections(run, truth, m);
  evaluate_services(run, m);
  evaluate_sensing(run, m);
  std::copy_if(run.faults.begin(), run.faults.end(), std::back_inserter(m.fdir),
               [](const FaultRecord& fault) { return fault.active; });
  m.bus = run.bus;
  if (info.sim_s && info.wall_s && *info.wall_s > 0.0) m.realtime_factor = *info.sim_s / *info.wall_s;
  evaluation.incidents = evaluate_stops(run, truth, m.window, footprint, world.value_or(TrueWorld{}));
  m.unobserved_stops = static_cast<int>(std::count_if(evaluation.incidents.begin(), evaluation.incidents.end(),
                                                      [](const Incident& incident) { return incident.unseen; }));
  if (world) evaluate_world(run, truth, footprint, *world, evaluation);
  m.outcome = outcome_of(run, m);
  return evaluation;
}

}  // namespace rover::report
