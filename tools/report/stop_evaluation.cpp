#include "tools/report/stop_evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace rover::report {
namespace {

constexpr double kMemoryS = 30.0;  // older hazards are behind the rover
constexpr double kAheadM = 5.0;    // length of the old path that is checked for a cause
// Clearance from the swept footprint to a cell's centre. Paths keep about 0.2 m; 0.35 m covers margins that grew with
// uncertainty.
constexpr double kClearancesM[] = {0.20, 0.35};
constexpr double kUnseenWindowS = 1.0;  // time within which the planner must have reported unseen ground as the cause

const PathRecord* path_by_id(const RunRecord& run, std::int64_t id, double t_s) {
  const PathRecord* found = nullptr;
  for (const PathRecord& path : run.global_paths)
    if (path.id == id && path.t_s <= t_s) found = &path;
  for (const PathRecord& path : run.local_paths)
    if (path.id == id && path.t_s <= t_s) found = &path;
  return found;
}

// Transform of the rover's map or odom frame to truth, from the present pose alone.
Pose2 frame_in_truth(const RunRecord& run, const TrueTrack& truth, bool odom, double t_s) {
  const PoseSample* pose = newest(run.poses, t_s);
  if (pose == nullptr || truth.empty()) return {};
  const Pose2 estimate = planar(odom ? pose->T_odom_body : pose->T_map_odom * pose->T_odom_body);
  return compose(truth.planar_at(pose->t_s), inverse(estimate));
}

// Centres of the hazard cells known at t, without duplicates.
Points known_cells(const RunRecord& run, const TrueTrack& truth, const Footprint& footprint, double t_s) {
  Points cells;
  std::set<std::pair<int, int>> taken;
  for (const HazardMap& map : run.hazards) {
    if (map.cells.empty() || map.released_s > t_s || map.released_s < t_s - kMemoryS || truth.empty()) continue;
    const Eigen::Isometry3d T_map_body = truth.at(map.t_s);
    for (const HazardCell& cell : map.cells) {
      const Eigen::Vector2d p = cell_in_map(cell, T_map_body, footprint.origin_height_m);
      const auto index = [&](double v) { return static_cast<int>(std::floor(v / map.cell_m)); };
      if (taken.emplace(index(p.x()), index(p.y())).second) cells.push_back(p);
    }
  }
  return cells;
}

// The cells within clearance of the footprint swept along the line.
Points colliding_cells(const Points& line, const Points& cells, const Footprint& footprint, double clearance_m) {
  constexpr double kStepM = 0.1;
  Points hit;
  for (const Eigen::Vector2d& cell : cells) {
    bool collides = false;
    for (size_t i = 0; i + 1 < line.size() && !collides; ++i) {
      const Eigen::Vector2d step = line[i + 1] - line[i];
      const double yaw = std::atan2(step.y(), step.x());
      for (double s = 0.0; s <= step.norm() && !collides; s += kStepM) {
        const Eigen::Vector2d p = line[i] + step.normalized() * s;
        const Eigen::Vector2d seen = transform(inverse(Pose2{p.x(), p.y(), yaw}), cell);
        collides = distance_to_box_m(seen, footprint.half_length_m, footprint.half_width_m) <= clearance_m;
      }
    }
    if (collides) hit.push_back(cell);
  }
  return hit;
}

// Largest residual of the surface from its fitted plane, within 0.4 m.
double relief_m(const TrueWorld& world, const Eigen::Vector2d& p) {
  constexpr int kReach = 4;
  constexpr double kStep = 0.1;
  Eigen::Matrix<double, Eigen::Dynamic, 3> A((2 * kReach + 1) * (2 * kReach + 1), 3);
  Eigen::VectorXd z(A.rows());
  int row = 0;
  for (int i = -kReach; i <= kReach; ++i)
    for (int j = -kReach; j <= kReach; ++j, ++row) {
      A.row(row) << 1.0, i * kStep, j * kStep;
      z(row) = world.height_m(p.x() + i * kStep, p.y() + j * kStep);
    }
  const Eigen::Vector3d plane = A.colPivHouseholderQr().solve(z);
  return (z - A * plane).cwiseAbs().maxCoeff();
}

void evaluate_cause(Incident& incident, const RockIndex& rocks, const TrueWorld& world) {
  for (const Eigen::Vector2d& cell : incident.cells) {
    for (const size_t i : rocks.near(cell, kRealRadiusM))
      incident.tallest_rock_m = std::max(incident.tallest_rock_m, rocks.rocks()[i].height_m);
    if (!incident.real && world.height_m) incident.real = relief_m(world, cell) >= kRealReliefM;
  }
  incident.real |= incident.tallest_rock_m >= kRealRockM;
}

bool unseen_named(const RunRecord& run, double t_s) {
  return std::any_of(run.planner.begin(), run.planner.end(), [t_s](const PlannerSample& sample) {
    return sample.blocked_by_unseen && sample.t_s <= t_s && sample.t_s > t_s - kUnseenWindowS;
  });
}

// A path republished because of a map correction is not a replan; the planner does not count it.
bool counted_as_replan(const RunRecord& run, const PathRecord& path) {
  constexpr double kBeforeS = 0.3;  // the path is released some ticks after the planner counted it
  constexpr double kAfterS = 0.05;
  if (run.planner.empty()) return true;
  const PlannerSample* before = newest(run.planner, path.t_s - kBeforeS);
  const PlannerSample* after = newest(run.planner, path.t_s + kAfterS);
  return after != nullptr && (before == nullptr ? after->replans > 0 : after->replans != before->replans);
}

std::vector<Incident> find_incidents(const RunRecord& run, const TrueTrack& truth, const Window& window) {
  std::vector<Incident> incidents;
  for (size_t i = 0; i < run.states.size(); ++i) {
    if (!hazard_stop_begins(run, i) || !window.contains(run.states[i].t_s)) continue;
    Incident incident;
    incident.t_s = run.states[i].t_s;
    incident.stopped = true;
    incidents.push_back(incident);
  }
  for (const PathRecord& path : run.local_paths) {
    if (!path.is_repair || !window.contains(path.t_s) || !counted_as_replan(run, path)) continue;
    const Points placed = path_in_truth(run, truth, path, path.t_s);
    // A repair after a stop belongs to the stop until the rover drives again.
    const auto stop = std::find_if(incidents.begin(), incidents.end(), [&](const Incident& incident) {
      return incident.stopped && !incident.replanned && incident.t_s <= path.t_s &&
             std::none_of(run.states.begin(), run.states.end(), [&](const StateChange& change) {
               return change.state == State::kDriving && change.t_s > incident.t_s && change.t_s < path.t_s;
             });
    });
    if (stop != incidents.end()) {
      stop->replanned = true;
      stop->new_path = placed;
      continue;
    }
    Incident incident;
    incident.t_s = path.t_s;
    incident.replanned = true;
    incident.new_path = placed;
    incidents.push_back(incident);
  }
  std::sort(incidents.begin(), incidents.end(), [](const Incident& a, const Incident& b) { return a.t_s < b.t_s; });
  return incidents;
}

}  // namespace

bool hazard_stop_begins(const RunRecord& run, size_t change) {
  return run.states[change].state == State::kHazardStop &&
         (change == 0 || run.states[change - 1].state != State::kHazardStop);
}

Points path_in_truth(const RunRecord& run, const TrueTrack& truth, const PathRecord& path, double t_s) {
  const Pose2 frame = frame_in_truth(run, truth, path.in_odom, t_s);
  Points placed;
  for (const Eigen::Vector2d& p : path.points) placed.push_back(transform(frame, p));
  return placed;
}

Points followed_path(const RunRecord& run, const TrueTrack& truth, double t_s) {
  const ControlSample* control = newest(run.control, t_s);
  const PathRecord* path = control == nullptr ? nullptr : path_by_id(run, control->path_id, t_s);
  return path == nullptr ? Points{} : path_in_truth(run, truth, *path, t_s);
}

std::vector<Incident> evaluate_stops(const RunRecord& run, const TrueTrack& truth, const Window& window,
                                     const Footprint& footprint, const TrueWorld& world) {
  constexpr double kLeadS = 0.04;  // two ticks: the new path may already be active at the incident
  std::vector<Incident> incidents = find_incidents(run, truth, window);
  const RockIndex rocks(world.rocks);
  for (Incident& incident : incidents) {
    incident.old_path = followed_path(run, truth, incident.t_s - kLeadS);
    const Eigen::Vector2d here =
        truth.empty() ? Eigen::Vector2d::Zero() : Eigen::Vector2d(truth.at(incident.t_s).translation().head<2>());
    const Points ahead = part_ahead(incident.old_path, here, kAheadM);
    const Points known = known_cells(run, truth, footprint, incident.t_s);
    for (const double clearance : kClearancesM)
      if (incident.cells.empty()) incident.cells = colliding_cells(ahead, known, footprint, clearance);
    incident.unseen = incident.cells.empty() && unseen_named(run, incident.t_s);
    evaluate_cause(incident, rocks, world);
  }
  return incidents;
}

}  // namespace rover::report
