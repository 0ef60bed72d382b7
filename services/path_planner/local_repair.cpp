#include "path_planner/local_repair.hpp"

#include "common/core/distance_field.hpp"

namespace rover::planning {
namespace {

constexpr double kPathStepM = 0.1;
constexpr double kBorderM = 0.5;        // of the map, where nothing is joined
constexpr double kShortestJoinM = 0.5;  // ahead of the rover
constexpr double kSoonM = 1.0;          // reach of "as soon as possible": what an arc needs to come in
constexpr double kSoonFactor = 3.0;     // prices the global path, so that an early join is worth a longer way
constexpr double kNearM = 1.2;          // the rover may stand closer to a hazard than it would go
constexpr double kTightCost = 8.0;      // per metre there
constexpr double kBareM = 0.05;         // nearer than the half width less this nothing passes
constexpr double kMarchBeyond = 6.0;    // travel cost, as much as a point turn and a way round
constexpr double kMostClearanceM = 2.0;
constexpr double kLeastSmoothM = 0.6;
constexpr double kSeenMarginM = 0.04;  // the rover follows a path within centimetres
constexpr double kGoalMissCost = 3.0;  // per metre that a way ends off the goal
constexpr double kViewReserveM = 0.06;
constexpr double kViewStepM = 0.1;
constexpr double kViewStepRad = 0.4;

// The stretch of the global path from `from_m` that lies inside the map.
std::vector<double> stations(const Route& global, const Terrain& terrain, double from_m) {
  std::vector<double> out;
  for (double s = from_m; s < global.length_m(); s += kPathStepM) {
    if (terrain.inside_m(global.point_at(s)) < kBorderM) return out;
    out.push_back(s);
  }
  if (terrain.inside_m(global.point_at(global.length_m())) >= kBorderM) out.push_back(global.length_m());
  return out;
}

// What the search counts on, so that the finer samples of the verification and the smoothing still hold.
ViewArea narrowed(ViewArea view) {
  view.near_half_width_m -= kViewReserveM;
  view.far_half_width_m -= kViewReserveM;
  view.far_m -= kViewReserveM;
  return view;
}

// The goal itself may lie under a hazard: each cell from which it counts as reached is an end.
void append_goal_seeds(const Terrain& terrain, Point2 goal, double reach_m, std::vector<Seed>& seeds) {
  const int reach = static_cast<int>(std::ceil(reach_m / terrain.cell_m()));
  for (int dy = -reach; dy <= reach; ++dy)
    for (int dx = -reach; dx <= reach; ++dx) {
      const Point2 p{goal.x_m + dx * terrain.cell_m(), goal.y_m + dy * terrain.cell_m()};
      const double miss_m = distance(p, goal);
      if (miss_m <= reach_m && terrain.contains(p)) seeds.push_back({terrain.cell_of(p), kGoalMissCost * miss_m});
    }
}

void append(std::vector<Pose2>& way, const std::vector<Pose2>& section) {
  way.insert(way.end(), section.begin(), section.end());
}

}  // namespace

const char* text_of(RepairStatus status) {
  switch (status) {
    case RepairStatus::kFound:
      return "repair found";
    case RepairStatus::kNoTarget:
      return "the known part of the global path is blocked";
    case RepairStatus::kNoWay:
      return "hazards block every path to the global path";
    case RepairStatus::kUnseen:
      return "unseen ground blocks every path to the global path";
  }
  return "";
}

RepairResult LocalRepair::plan(const RepairRequest& request) const {
  const FootprintCheck check(request.terrain, config_.footprint, request.margin_m, kSeenMarginM, request.start);
  const FootprintCheck turn_check(request.terrain, config_.footprint, request.margin_m + config_.turn_extra_m,
                                  kSeenMarginM, request.start);
  RepairResult result;
  std::vector<JoinTarget> targets = join_targets(request, check);
  MarchGrid cost = travel_costs(request, check);
  std::vector<Seed> seeds;
  for (JoinTarget& target : targets)
    seeds.push_back({request.terrain.cell_of(position(target.pose)), target.travel_cost});

  const Point2 end = request.global.point_at(request.global.length_m());
  std::optional<Point2> goal;
  if (request.terrain.inside_m(end) >= kBorderM) {
    goal = end;
    append_goal_seeds(request.terrain, end, request.goal_reach_m, seeds);
  }
  if (seeds.empty()) {
    result.status = RepairStatus::kNoTarget;
    return result;
  }
  const std::vector<double> travel = march(cost, seeds, request.terrain.cell_of(position(request.start)), kMarchBeyond);
  const SearchResult way = search_arcs(
      config_.search, {check, turn_check, cost, travel, narrowed(config_.view), targets, goal, request.goal_reach_m,
                       kGoalMissCost, request.start, request.start_curvature_per_m, request.sure_m, request.stopped});
  result.expansions = way.expansions;
  if (!way.found) {
    result.status = way.unseen_in_the_way ? RepairStatus::kUnseen
                    : targets.empty()     ? RepairStatus::kNoTarget
                                          : RepairStatus::kNoWay;
    return result;
  }
  result.poses = best_poses(request, check, way, result.smoothed);
  if (result.poses.empty()) {
    result.status = RepairStatus::kUnseen;
    return result;
  }
  result.status = RepairStatus::kFound;
  result.turns_first = way.turns_first;
  result.halts = static_cast<int>(way.sections.size()) - 1;
  result.join_m = way.target >= 0 ? targets[way.target].way_m : request.global.length_m();
  result.clearance_m = kMostClearanceM;
  for (const Pose2& pose : result.poses) result.clearance_m = check.clearance_m(pose, result.clearance_m);
  return result;
}

// Clear poses past the last known blockage, within the reach that the configuration asks for.
std::vector<JoinTarget> LocalRepair::join_targets(const RepairRequest& request, const FootprintCheck& check) const {
  const std::vector<double> way = stations(request.global, request.terrain, request.from_m + kShortestJoinM);
  size_t first = 0;
  for (size_t i = 0; i < way.size(); ++i)
    if (!check.clear(request.global.pose_at(way[i]))) first = i + 1;
  std::vector<JoinTarget> targets;
  if (first == way.size()) return targets;
  const bool soon = config_.rejoin_within_m <= 0.0;
  const double reach_m = soon ? kSoonM : config_.rejoin_within_m;
  for (size_t i = first; i < way.size() && way[i] <= way[first] + reach_m; ++i) {
    JoinTarget target{request.global.pose_at(way[i]), way[i], 0.0};
    if (std::isfinite(
            ground_cost(request.terrain, request.terrain.cell_of(position(target.pose)), request.margin_m, false)))
      targets.push_back(target);
  }
  double ahead = 0.0;
  for (size_t i = targets.size(); i-- > 0;) {
    targets[i].travel_cost = ahead;
    if (i == 0) break;
    const int cell = request.terrain.cell_of(position(targets[i].pose));
    ahead += (targets[i].way_m - targets[i - 1].way_m) * (soon ? kSoonFactor : 1.0) *
             ground_cost(request.terrain, cell, request.margin_m, false);
  }
  return targets;
}

double LocalRepair::ground_cost(const Terrain& terrain, int cell, double margin_m, bool near) const {
  const double room = terrain.hazard_distance_m(cell) - config_.footprint.half_width_m;
  if (room < -kBareM) return kInfinity;
  if (room < margin_m) return near ? kTightCost : kInfinity;
  const double lack = std::max(0.0, 1.0 - (room - margin_m) / config_.risk_distance_m);
  return 1.0 + config_.risk_cost * lack * lack + (terrain.unseen(cell) ? config_.unseen_cost : 0.0);
}

MarchGrid LocalRepair::travel_costs(const RepairRequest& request, const FootprintCheck& check) const {
  const Terrain& terrain = request.terrain;
  MarchGrid grid{terrain.cells(), terrain.cells(), terrain.cell_m(), {}};
  const size_t count = static_cast<size_t>(terrain.cells()) * terrain.cells();
  std::vector<std::uint8_t> path(count, 0);
  for (double s = std::max(0.0, request.from_m - 6.0); s <= std::min(request.from_m + 12.0, request.global.length_m());
       s += kPathStepM)
    if (const Point2 p = request.global.point_at(s); terrain.contains(p)) path[terrain.cell_of(p)] = 1;
  const std::vector<double> off_path = distance_field(path, terrain.cells(), terrain.cells(), terrain.cell_m());
  const double at_start = off_path[terrain.cell_of(position(request.start))];
  const double most = std::max(config_.max_deviation_m, at_start + kSoonM);
  grid.cost_per_m.resize(count);
  for (size_t i = 0; i < count; ++i) {
    const int cell = static_cast<int>(i);
    const bool near = distance(terrain.center_of(cell), position(request.start)) < kNearM;
    grid.cost_per_m[i] = off_path[i] > most ? kInfinity : ground_cost(terrain, cell, check.margin_m(), near);
    for (const DeadEnd& end : request.dead_ends)
      if (distance(terrain.center_of(cell), end.p) < config_.dead_end_reach_m) grid.cost_per_m[i] += end.cost_per_m;
  }
  return grid;
}

std::vector<Pose2> LocalRepair::best_poses(const RepairRequest& request, const FootprintCheck& check,
                                           const SearchResult& way, bool& smoothed) const {
  std::vector<Pose2> rough;
  std::vector<Pose2> fine;
  for (const WaySection& section : way.sections) {
    const std::vector<Pose2> arcs = sample(section.start, section.segments, kPoseStepM);
    const bool moving = rough.empty() && !way.turns_first;
    const std::vector<Pose2> curve = smoothed_section(request, section, moving ? request.start_curvature_per_m : 0.0);
    append(rough, arcs);
    append(fine, curve.empty() ? arcs : curve);
  }
  smoothed = verified(fine, check, config_.view, request.sure_m);
  if (smoothed) return fine;
  return verified(rough, check, config_.view, request.sure_m) ? rough : std::vector<Pose2>{};
}

std::vector<Pose2> LocalRepair::smoothed_section(const RepairRequest& request, const WaySection& section,
                                                 double curvature_per_m) const {
  double length = 0.0;
  for (const ArcSegment& arc : section.segments) length += arc.length_m;
  if (length < kLeastSmoothM) return {};
  return smooth(
             config_.smoother,
             {request.terrain, config_.footprint, request.margin_m, section.start, curvature_per_m, section.segments},
             kPoseStepM)
      .value_or(std::vector<Pose2>{});
}

double seen_way_m(const std::vector<Pose2>& poses, const FootprintCheck& check, const ViewArea& view) {
  SeenOnTheWay seen(check, view);
  Pose2 noted = poses.front();
  seen.passed(noted);
  double way = 0.0;
  for (size_t i = 1; i < poses.size(); ++i) {
    way += distance(position(poses[i - 1]), position(poses[i]));
    if (!seen.covers(poses[i])) return way;
    const bool near = distance(position(noted), position(poses[i])) < kViewStepM &&
                      std::abs(poses[i].yaw_rad - noted.yaw_rad) < kViewStepRad;
    if (near) continue;
    // A jump of the heading is a point turn, and the camera sweeps what lies between.
    const double turn = poses[i].yaw_rad - noted.yaw_rad;
    const int views = std::max(1, static_cast<int>(std::ceil(std::abs(turn) / kViewStepRad)));
    for (int k = 1; k <= views; ++k) seen.passed({poses[i].x_m, poses[i].y_m, noted.yaw_rad + turn * k / views});
    noted = poses[i];
  }
  return kInfinity;
}

bool verified(const std::vector<Pose2>& poses, const FootprintCheck& check, const ViewArea& view, double sure_m) {
  return poses.size() >= 2 && std::all_of(poses.begin(), poses.end(), [&](const Pose2& p) { return check.clear(p); }) &&
         seen_way_m(poses, check, view) >= sure_m;
}

}  // namespace rover::planning
