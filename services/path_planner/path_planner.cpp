#include "path_planner/path_planner.hpp"

#include <cmath>
#include <utility>

#include "common/core/path_limits.hpp"
#include "path_planner/dubins.hpp"

namespace rover::planning {
namespace {

constexpr double kMonitorSideM = 14.0;  // of the costmap for the path check
constexpr double kSearchGlobalM = 3.0;  // along the global path, around the rover
constexpr double kKeepBehindM = 0.3;
constexpr double kStationaryMps = 0.02;
constexpr double kStationaryRadps = 0.02;
constexpr double kCreepMps = 0.05;  // of the body origin while the rover turns on the spot
constexpr double kHalfCellM = 0.5 * BeliefConfig::kCellM;
constexpr double kControlM = 0.05;
constexpr double kGoalNearM = 1.0;
constexpr double kGoalToleranceRatio = 0.6;  // of the goal's tolerance, for a plan
constexpr double kProgressM = 1.0;           // of the global path, after which backing up counts anew
constexpr double kMinBackUpM = 0.3;
constexpr double kBackUpToleranceM = 0.1;
constexpr double kShortBackUpSPerM = 50.0;  // per metre that is not backed up
constexpr int kMaxWantedBackUps = 2;
constexpr double kPoseStepM = 0.05;
constexpr double kMinIncumbentM = 2.5;  // a shorter rest of the active plan does not bind the next one
constexpr double kTailRadiusM = 2.0;
constexpr double kTailAheadM = 3.0;

double smooth_step(double u) {
  const double v = std::clamp(u, 0.0, 1.0);
  return v * v * (3.0 - 2.0 * v);
}

double length_m(const std::vector<PlanPose>& poses) {
  double sum = 0.0;
  for (size_t i = 1; i < poses.size(); ++i) sum += distance(position(poses[i - 1].pose), position(poses[i].pose));
  return sum;
}

HybridPlannerConfig planner_config(const PathPlannerConfig& config) {
  HybridPlannerConfig out = config.planner;
  out.footprint = config.footprint;
  out.view = config.belief.view;
  return out;
}

}  // namespace

std::string GlobalPath::fault() const {
  if (points.size() < 2) return "path has fewer than 2 points";
  double length = 0.0;
  for (size_t i = 0; i < points.size(); ++i) {
    if (!std::isfinite(points[i].p.x_m) || !std::isfinite(points[i].p.y_m))
      return "point " + std::to_string(i) + " of the path is not finite";
    if (i > 0) length += distance(points[i - 1].p, points[i].p);
  }
  if (const std::string problem = path_length_problem(length); !problem.empty()) return problem;
  if (goal_tolerance_m < 0.0 || std::isinf(goal_tolerance_m)) return "goal tolerance is out of range";
  if (corridor_half_width_m < 0.0 || std::isinf(corridor_half_width_m)) return "corridor is out of range";
  if (const std::string problem = zones_problem(zones); !problem.empty()) return problem;
  for (const auto& [end, p] : {std::pair{"starts", points.front().p}, std::pair{"ends", points.back().p}})
    if (const Zone* zone = forbidding_zone(zones, {p.x_m, p.y_m}))
      return std::string("path ") + end + (zone->keep_in ? " outside of keep-in '" : " in keep-out '") + zone->name +
             "'";
  return "";
}

PathPlanner::PathPlanner(const PathPlannerConfig& config, std::int64_t first_path_id,
                         std::shared_ptr<Background> background)
    : config_(config),
      planner_(make_planner(config.planner_name, planner_config(config))),
      background_(std::move(background)),
      belief_(config.belief),
      next_path_id_(first_path_id) {}

std::string PathPlanner::set_global_path(const GlobalPath& path) {
  if (const std::string fault = path.fault(); !fault.empty()) return fault;
  global_ = path;
  if (!(path.goal_tolerance_m > 0.0)) global_->goal_tolerance_m = config_.goal_tolerance_m;
  if (!(path.corridor_half_width_m > 0.0)) global_->corridor_half_width_m = config_.corridor_half_width_m;
  global_map_ = rounded(path.points, config_.rounding);
  forget_path();
  back_ups_ = wanted_back_ups_ = 0;
  furthest_m_ = 0.0;
  return "";
}

void PathPlanner::set_start_area(Point2 center_map, double radius_m, Utime utime) {
  start_area_ = StartArea{center_map, radius_m, utime};
}

void PathPlanner::add_pose(const PoseSample& sample) {
  if (!sample.usable) {
    history_.clear();  // what comes after need not fit to what was before
    breadcrumbs_.clear();
    side_slip_ = {};
    job_.reset();
    if (sample.new_odom && !std::exchange(odom_ended_, true)) {
      belief_ = BeliefMap(config_.belief);
      forget_path();
    }
    return;
  }
  odom_ended_ = false;
  history_.add(sample);
  side_slip_.learn(rover().yaw_rad, sample.forward_mps, sample.left_mps, to_seconds(kTickUs));
  belief_.move_to(position(rover()));
  apply_start_area();
  belief_.mark_driven(rover(), config_.footprint);
  if (mode_ == Mode::kBackingUp || sample.forward_mps < -kStationaryMps)
    breadcrumbs_.retrace(position(rover()));
  else
    breadcrumbs_.extend(position(rover()));
}

void PathPlanner::apply_start_area() {
  if (!start_area_ || history_.newest().utime <= start_area_->utime) return;
  const Point2 center = from_body(inverse(planar(history_.newest().T_map_odom)), start_area_->center_map);
  if (start_area_->radius_m > 0.0) belief_.mark_known(center, start_area_->radius_m);
  start_area_.reset();
  forget_path();
  new_ground_ = true;
}

void PathPlanner::forget_path() {
  back_up_wanted_ = replan_wanted_ = false;
  global_odom_.reset();
  active_.clear();
  job_.reset();
  back_up_plan_.reset();
  failures_ = 0;
  mode_ = Mode::kIdle;
}

bool PathPlanner::add_hazards(const HazardGrid& grid) {
  const std::optional<Eigen::Isometry3d> T = history_.at(grid.utime);
  if (!T || !grid.fault().empty()) return false;
  belief_.add(grid, *T);
  new_ground_ = true;
  return true;
}

void PathPlanner::set_level(bool full) {
  if (full == full_level_) return;
  full_level_ = full;
  new_level_ = true;
  mapped_ = false;
}

bool PathPlanner::add_traversability(const TraversabilityGrid& map) {
  const std::optional<Eigen::Isometry3d> T = history_.at(map.utime);
  if (!full_level_ || !T || !map.fault().empty()) return false;
  const double dead_reckoned_m = history_.newest().dead_reckoned_m;
  belief_.add_drift(dead_reckoned_m - std::exchange(dead_reckoned_m_, dead_reckoned_m));
  belief_.add(map, planar(*T), config_.footprint);
  new_ground_ = new_map_ = mapped_ = true;
  return true;
}

bool PathPlanner::ready(Utime now) const {
  return global_ && !history_.empty() && now - history_.newest().utime <= to_utime(config_.pose_max_age_s);
}

bool PathPlanner::stationary() const {
  return std::abs(history_.newest().forward_mps) < kStationaryMps &&
         std::abs(history_.newest().yaw_rate_radps) < kStationaryRadps;
}

PlannerOutput PathPlanner::step(Utime now) {
  PlannerOutput out;
  if (ready(now)) {
    if (!global_odom_) {
      set_global_in_odom(planar(history_.newest().T_map_odom));
      global_progress_m_ = place_on_global_path();
    }
    if (active_.empty()) follow_global_path();
    if (!active_.empty()) follow();
    take_plan(now);
    if (new_ground_ && !active_.empty()) check_path();
  }
  const Mode before = mode_;
  mode_ = next_mode(mode_, facts(now));
  if (mode_ == Mode::kBackingUp && before != mode_) back_up();
  if (before == Mode::kNoPath && mode_ == Mode::kPlanning) failures_ = back_ups_ = wanted_back_ups_ = 0;
  if (before != mode_ && mode_ == Mode::kFollowing) failures_ = 0;
  if (mode_ == Mode::kNoPath && new_ground_) back_up_plan_.reset();
  if (ready(now)) request(now);
  new_ground_ = new_level_ = false;
  if (ready(now) && !active_.empty() && active_.id() != sent_path_id_) {
    sent_path_id_ = active_.id();
    out.path = published();
  }
  out.status = status(now);
  return out;
}

void PathPlanner::request(Utime now) {
  if (wants_back_up())
    request_back_up_plan();
  else if (wants_plan())
    request_plan();
  take_plan(now);
}

void PathPlanner::set_global_in_odom(const Pose2& T_map_odom) {
  T_map_odom_ = T_map_odom;
  const Pose2 T_odom_map = inverse(T_map_odom_);
  global_odom_ = std::make_shared<const Route>(transformed(global_map_, T_odom_map));
  zones_odom_ = global_->zones;
  for (Zone& zone : zones_odom_)
    for (Eigen::Vector2d& p : zone.points) {
      const Point2 in_odom = from_body(T_odom_map, {p.x(), p.y()});
      p = {in_odom.x_m, in_odom.y_m};
    }
}

// A path that begins at the rover may pass there again, but later; others are joined midway.
double PathPlanner::place_on_global_path() const {
  const std::vector<RoutePoint>& points = global_odom_->points();
  const auto far = std::find_if(points.begin(), points.end(), [&](const RoutePoint& point) {
    return distance(point.p, position(rover())) > PathPlannerConfig::kMaxStartOffsetM;
  });
  if (far == points.begin() || far == points.end()) return global_odom_->closest(position(rover()));
  return global_odom_->closest(position(rover()), 0.0, global_odom_->s_at(static_cast<size_t>(far - points.begin())));
}

// From here on; if the rover is far off, a path to it has to be planned.
void PathPlanner::follow_global_path() {
  const Point2 start = global_odom_->point_at(global_progress_m_);
  if (distance(start, position(rover())) > PathPlannerConfig::kMaxStartOffsetM) return;
  std::vector<RoutePoint> points;
  const size_t count = global_odom_->points().size();
  const size_t next = std::min(global_odom_->vertex_after(global_progress_m_), count - 1);
  if (global_odom_->length_m() - global_progress_m_ > kPoseStepM)
    points.push_back({start, global_progress_m_, global_odom_->level_at(global_progress_m_)});
  else
    points.push_back(global_odom_->points()[count - 2]);  // the rover is at the end: the last piece is the path
  for (size_t i = next; i < count; ++i) points.push_back(global_odom_->points()[i]);
  active_.set_route(next_path_id_++, PathKind::kGlobal, Route(std::move(points)), global_->corridor_half_width_m,
                    rover());
  track_turn();
  check_path();
}

void PathPlanner::follow() {
  active_.follow(rover(), history_.newest().forward_mps);
  track_progress();
  track_turn();
  // Past a plan the path is the global path again, with its own corridor; at the Full level there is another plan
  // before.
  const bool plan = active_.kind() == PathKind::kRepair || (active_.kind() == PathKind::kContinuous && !full_level_);
  if (plan && active_.planned_m() < 0.0) {
    std::vector<RoutePoint> rest;
    const std::vector<RoutePoint>& points = active_.route().points();
    const double from_m = std::max(active_.progress_m() - kKeepBehindM, active_.segment().begin_m);
    for (size_t i = active_.route().vertex_after(from_m) - 1; i < points.size(); ++i) rest.push_back(points[i]);
    if (rest.size() >= 2) {
      active_.set_route(next_path_id_++, PathKind::kGlobal, Route(std::move(rest)), global_->corridor_half_width_m,
                        rover());
      check_path();
    }
  }
  follow_correction();
}

void PathPlanner::track_progress() {
  global_progress_m_ = global_odom_->closest(position(rover()), global_progress_m_ - kSearchGlobalM,
                                             global_progress_m_ + kSearchGlobalM);
  if (global_progress_m_ < furthest_m_ + kProgressM) return;
  furthest_m_ = global_progress_m_;
  back_ups_ = wanted_back_ups_ = 0;
}

// As trajectory_control does: a point turn goes on below the error that starts one.
bool PathPlanner::turns_to(double yaw_rad) const {
  const double error_rad = std::abs(wrap_angle(yaw_rad - rover().yaw_rad));
  const bool slow = std::abs(history_.newest().forward_mps) <= kCreepMps;
  return error_rad > (turning_ && slow ? config_.turn_stop_rad : config_.turn_threshold_rad);
}

void PathPlanner::track_turn() {
  turning_ = turns_to(active_.route().pose_at(active_.progress_m()).yaw_rad);
}

// Map has moved against odom: hazards and plans stay, the part of the path that is global moves, at bounded curvature
// and not before the end of the plan.
void PathPlanner::follow_correction() {
  const Pose2 T_now = planar(history_.newest().T_map_odom);
  const auto moved_m = [&](Point2 p) { return distance(from_body(inverse(T_now), from_body(T_map_odom_, p)), p); };
  const double change =
      std::max(moved_m(position(rover())), moved_m(active_.route().point_at(active_.progress_m() + 10.0)));
  if (change < PathPlannerConfig::kCorrectionM) return;
  set_global_in_odom(T_now);
  const double search_m = kSearchGlobalM + change;
  global_progress_m_ =
      global_odom_->closest(position(rover()), global_progress_m_ - search_m, global_progress_m_ + search_m);
  if (mode_ == Mode::kBackingUp) {  // over the driven track, which lies in odom; only the zones move
    if (!zones_odom_.empty()) active_.replace_route(next_path_id_++, active_.route());
    return;
  }
  const double begin = std::max(active_.progress_m() + 1.0, active_.progress_m() + active_.planned_m());
  // Of the blend 3u^2 - 2u^3: slope at most 0.33, curvature at most 0.3 per metre.
  const double ramp = std::max({3.0, 4.5 * change, std::sqrt(20.0 * change)});
  std::vector<RoutePoint> points = active_.route().points();
  for (size_t i = 0; i < points.size(); ++i) {
    if (std::isnan(points[i].global_s_m)) continue;
    const Point2 target = global_odom_->point_at(points[i].global_s_m);
    const double w = smooth_step((active_.route().s_at(i) - begin) / ramp);
    points[i].p = {points[i].p.x_m + w * (target.x_m - points[i].p.x_m),
                   points[i].p.y_m + w * (target.y_m - points[i].p.y_m)};
  }
  active_.replace_route(next_path_id_++, Route(std::move(points)));
  check_path();
}

double PathPlanner::margin_m() const {
  const Clearances& clearances = config_.planner.clearances;
  if (mode_ == Mode::kBackingUp) return clearances.min_m - 2.0 * Clearances::kToleranceM;
  return active_.kind() == PathKind::kGlobal ? clearances.turn_m : clearances.min_m - Clearances::kToleranceM;
}

Costmap PathPlanner::monitor_costmap(CostmapUse use) const {
  CostmapConfig config = config_.costmap;
  config.use = use;
  return Costmap(config, belief_, position(rover()), kMonitorSideM, zones_odom_);
}

void PathPlanner::check_path() {
  const Costmap costmap = monitor_costmap(mode_ == Mode::kBackingUp ? CostmapUse::kBackingUp : CostmapUse::kGoingOn);
  blockage_ =
      find_blockage({costmap, active_.route(), config_.footprint, active_.progress_m(), rover(), active_.planned_from(),
                     margin_m(), config_.planner.roll, turning_, config_.belief.view, side_slip_});
  // No camera looks backwards, and the driven track was known.
  if (mode_ == Mode::kBackingUp) blockage_.unknown_m = blockage_.unseen_m = kInfinity;
}

bool PathPlanner::strayed() const {
  return distance(active_.route().point_at(active_.progress_m()), position(rover())) > active_.corridor_half_width_m();
}

bool PathPlanner::clear() const {
  if (active_.empty()) return false;
  const bool ended = active_.at_end(position(rover())) && !leads_to_goal();
  return !ended && !replan_wanted_ && !strayed() && hazard_ahead_m() > config_.stop_hazard_m &&
         unknown_ahead_m() > config_.stop_unknown_m;
}

std::uint16_t PathPlanner::facts(Utime now) {
  if (!ready(now)) return 0;
  std::uint16_t facts = kReady;
  if (clear()) facts |= kClear;
  if (new_level_) facts |= kNewLevel;
  if (!stationary()) {
    back_up_plan_.reset();
    return facts;
  }
  if (failed()) facts |= kFailed;
  if (back_up_wanted_) facts |= kBackUpWanted;
  if (!may_back_up() || (back_up_plan_ && !back_up_plan_->found))
    facts |= kCannotBackUp;
  else if (back_up_plan_)
    facts |= kCanBackUp;
  if (mode_ == Mode::kBackingUp &&
      (active_.at_end(position(rover())) || strayed() || replan_wanted_ || hazard_ahead_m() < config_.stop_hazard_m))
    facts |= kBackedUp;
  return facts;
}

bool PathPlanner::wants_plan() const {
  if (job_ || back_up_wanted_) return false;
  if (mode_ == Mode::kPlanning || mode_ == Mode::kNoPath) return new_ground_ || failures_ == 0;
  if (mode_ != Mode::kFollowing || turning_) return false;
  if (full_level_ && new_map_) return true;
  if (!new_ground_) return false;
  // Beyond a plan the path is provisional; it matters once the plan becomes short.
  const bool provisional = active_.kind() != PathKind::kGlobal && active_.planned_m() > kMinIncumbentM;
  const double matters_m = provisional ? active_.planned_m() : kInfinity;
  return hazard_ahead_m() < matters_m || unseen_ahead_m() < std::min(matters_m, config_.planner.search.known_free_m);
}

ExpectedMotion PathPlanner::expected_motion() const {
  return {active_.route(), active_.progress_m(), rover(), side_slip_, turning_};
}

double PathPlanner::stopping_distance_m() const {
  const double v = std::abs(history_.newest().forward_mps);
  return v * (config_.planning_latency_s + config_.release_latency_s) + 0.5 * v * v / config_.deceleration_mps2;
}

// Where the rover will be at the end of the committed part of the path; if that is blocked, where it can stop.
ActivePath::Start PathPlanner::plan_start() const {
  const double committed_m = stopping_distance_m();
  if (mode_ == Mode::kFollowing && !active_.empty()) {
    ActivePath::Start start = active_.start_after(committed_m);
    start.pose = expected_motion().at(start.at_m);
    if (std::min(blockage_.hazard_m, blockage_.unknown_m) > start.at_m) return start;
  }
  const PoseSample& now = history_.newest();
  if (stationary()) return {rover(), 0.0, false, kNaN};
  const double max_curvature = 1.0 / config_.rounding.min_radius_m;
  const double curvature = std::abs(now.forward_mps) > kStationaryMps
                               ? std::clamp(now.yaw_rate_radps / now.forward_mps, -max_curvature, max_curvature)
                               : 0.0;
  return {side_slip_.advanced(rover(), std::copysign(committed_m, now.forward_mps), curvature), curvature,
          now.forward_mps < 0.0, kNaN};
}

PlanRequest PathPlanner::request_from(const ActivePath::Start& start) const {
  PlanRequest request;
  request.global_path = global_odom_;
  request.global_progress_m = global_progress_m_;
  request.rover = rover();
  request.start = start.pose;
  request.start_curvature_per_m = start.curvature_per_m;
  request.start_reverse = start.reverse;
  request.turning = turning_ && stationary();
  request.side_slip = side_slip_;
  request.goal_tolerance_m = kGoalToleranceRatio * global_->goal_tolerance_m;
  return request;
}

void PathPlanner::request_plan() {
  Job job{active_.id(), plan_start(), std::isfinite(blockage_.hazard_m)};
  PlanRequest request = request_from(job.start);
  if (!std::isnan(job.start.at_m)) request.views = active_.views_until(job.start.at_m);
  if (!std::isnan(job.start.at_m) && clear()) request.incumbent = active_.plan_from(job.start.at_m, expected_motion());
  if (length_m(request.incumbent) < kMinIncumbentM) request.incumbent.clear();
  const auto make = [request, planner = planner_, belief = belief_, costmap = config_.costmap,
                     zones = zones_odom_]() mutable {
    const double side_m = belief.cells().cells() * belief.cells().cell_m();
    request.costmap = std::make_shared<const Costmap>(costmap, belief, position(request.rover), side_m, zones);
    return planner->plan(request);
  };
  if (!background_->start(make, history_.newest().utime)) return;
  job_ = job;
  new_map_ = false;
}

void PathPlanner::take_plan(Utime now) {
  if (!job_) return;
  const std::optional<Plan> plan = background_->result(now);
  if (!plan) return;
  const Job job = *std::exchange(job_, std::nullopt);
  const bool stale = job.path_id != active_.id() || mode_ == Mode::kBackingUp;
  if (stale) return;
  if (job.back_up)
    back_up_plan_ = *plan;
  else
    adopt(*plan, job);
}

void PathPlanner::adopt(const Plan& plan, const Job& job) {
  closed_in_ = plan.closed_in;
  if (!plan.found && !plan.keeps_incumbent) {
    ++failures_;
    needs_unseen_ground_ = plan.needs_unseen_ground;
    return;
  }
  if (plan.keeps_incumbent) {
    failures_ = 0;
    return;
  }
  std::vector<PlanPose> poses;
  if (!std::isnan(job.start.at_m)) {
    poses = active_.plan_until(job.start.at_m, expected_motion());
  } else {
    const double lead_m = distance(position(rover()), position(job.start.pose));
    if (lead_m > kPoseStepM) poses.push_back({rover(), job.start.reverse, 0.0});
  }
  poses.insert(poses.end(), plan.poses.begin(), plan.poses.end());
  const double corridor_m = std::clamp(plan.clearance_m - kHalfCellM - kControlM, config_.min_corridor_m,
                                       std::max(config_.min_corridor_m, global_->corridor_half_width_m));
  if (job.because_of_hazard && !full_level_) ++replans_;
  replan_wanted_ = back_up_wanted_ = false;
  active_.set_plan(next_path_id_++, full_level_ ? PathKind::kContinuous : PathKind::kRepair, poses,
                   tail(poses.back().pose, job.start.pose), corridor_m, global_odom_->level_at(global_progress_m_),
                   rover());
  track_turn();
  check_path();
  failures_ = clear() ? 0 : failures_ + 1;  // one that the path monitor refuses is a failure
}

// Beyond a plan the path leads back to the global one; before the rover comes there, there is another plan.
std::vector<RoutePoint> PathPlanner::tail(const Pose2& from, const Pose2& start) const {
  std::vector<RoutePoint> points;
  const double length = global_odom_->length_m();
  // Within the horizon a plan that ends beside the goal does so because the goal is blocked.
  const bool at_horizon = distance(position(from), position(start)) >= config_.planner.horizon_m;
  const double goal_radius_m =
      at_horizon ? kGoalToleranceRatio * global_->goal_tolerance_m
                 : std::max(config_.planner.cost_to_go.blocked_goal_radius_m, global_->goal_tolerance_m);
  if (distance(position(from), global_odom_->points().back().p) <= goal_radius_m) return points;
  const double station =
      global_odom_->closest(position(from), global_progress_m_, global_progress_m_ + 2.0 * config_.planner.horizon_m);
  const double off = distance(position(from), global_odom_->point_at(station));
  double join = station + 0.5 * kPoseStepM;
  if (off > kPoseStepM) {
    join = std::min(length, station + kTailAheadM + off);
    const Pose2 target = global_odom_->pose_at(join);
    const std::optional<DubinsPath> arcs = dubins_path(from, target, kTailRadiusM);
    const std::int8_t level = global_odom_->level_at(station);
    if (arcs && arcs->length_m() < 1.5 * distance(position(from), position(target))) {
      Pose2 pose = from;
      for (const ArcSegment& arc : arcs->segments) {
        const int steps = static_cast<int>(std::ceil(arc.length_m / (2.0 * kPoseStepM)));
        for (int i = 1; i <= steps; ++i)
          points.push_back({position(advanced(pose, arc.length_m * i / steps, arc.curvature_per_m)), kNaN, level});
        pose = advanced(pose, arc.length_m, arc.curvature_per_m);
      }
    } else {
      points.push_back({position(target), kNaN, level});
    }
  }
  for (size_t i = global_odom_->vertex_after(join + 0.5 * config_.rounding.step_m); i < global_odom_->points().size();
       ++i)
    points.push_back(global_odom_->points()[i]);
  return points;
}

// If all ways are known to be blocked, backing up helps only to see them once more from farther off.
bool PathPlanner::may_back_up() const {
  const bool asked = back_up_wanted_ ? wanted_back_ups_ < kMaxWantedBackUps : failed();
  return asked && back_ups_ < (failed() && closed_in_ ? 1 : config_.max_back_ups);
}

bool PathPlanner::wants_back_up() const {
  const bool blocked = back_up_wanted_ || mode_ == Mode::kPlanning;
  return blocked && mode_ != Mode::kBackingUp && !job_ && !back_up_plan_ && stationary() && may_back_up();
}

// To the driven track, as far behind as it shall back up; less costs. After a fault over driven ground, or, if that
// leads nowhere, over known ground.
void PathPlanner::request_back_up_plan() {
  const Job job{active_.id(), {rover(), 0.0, false, kNaN}, false, true};
  PlanRequest request = request_from(job.start);
  const std::deque<Point2>& track = breadcrumbs_.points();
  const double wanted_m = (1 + back_ups_) * config_.back_up_m;
  double behind_m = 0.0;
  for (size_t i = track.size(); i-- > 1;) {
    behind_m += distance(track[i - 1], track[i]);
    if (behind_m >= kMinBackUpM)
      request.back_to.push_back({track[i - 1], kShortBackUpSPerM * std::max(0.0, wanted_m - behind_m)});
  }
  if (request.back_to.empty()) {
    back_up_plan_.emplace();
    return;
  }
  request.goal_tolerance_m = kBackUpToleranceM;
  std::vector<std::shared_ptr<const Costmap>> costmaps;
  if (back_up_wanted_)
    costmaps.push_back(std::make_shared<const Costmap>(monitor_costmap(CostmapUse::kBackingUpOnTrack)));
  costmaps.push_back(std::make_shared<const Costmap>(monitor_costmap(CostmapUse::kBackingUp)));
  const auto make = [request, costmaps, planner = planner_]() mutable {
    Plan plan;
    for (size_t i = 0; i < costmaps.size() && !plan.found; ++i) {
      request.costmap = costmaps[i];
      plan = planner->plan(request);
    }
    return plan;
  };
  if (background_->start(make, history_.newest().utime)) job_ = job;
}

void PathPlanner::back_up() {
  ++back_ups_;
  if (back_up_wanted_) ++wanted_back_ups_;
  failures_ = 0;
  back_up_wanted_ = replan_wanted_ = false;
  job_.reset();
  active_.set_plan(next_path_id_++, PathKind::kBacktrack, std::exchange(back_up_plan_, std::nullopt)->poses, {},
                   config_.min_corridor_m, global_odom_->level_at(global_progress_m_), rover());
  track_turn();
  blockage_ = {};
}

// From the last cusp on: a controller that takes it anew shall not go back behind it.
LocalPath PathPlanner::published() const {
  const std::vector<RoutePoint>& points = active_.route().points();
  const size_t begin = active_.route().vertex_after(active_.segment().begin_m) - 1;
  return {active_.id(),
          active_.kind(),
          active_.corridor_half_width_m(),
          global_->goal_tolerance_m,
          {points.begin() + static_cast<std::ptrdiff_t>(begin), points.end()},
          zones_odom_};
}

PlannerStatus PathPlanner::status(Utime now) const {
  PlannerStatus status;
  status.replans = replans_;
  if (global_) status.global_path_id = global_->id;
  if (!ready(now)) {
    status.text = global_ ? "no fresh pose" : "no global path";
    return status;
  }
  status.corridor_offset_m = distance(global_odom_->point_at(global_progress_m_), position(rover()));
  const std::string failure = back_up_wanted_        ? "cannot back up from the fault"
                              : needs_unseen_ground_ ? "no path: the ground ahead does not come into view"
                                                     : "no path: hazards on all sides";
  if (active_.empty()) {
    status.state = mode_ == Mode::kNoPath ? PlannerState::kNoPath : PlannerState::kRepairing;
    status.text = "cannot reach the global path" + (failures_ > 0 ? ": " + failure : " yet");
    return status;
  }
  status.path_id = active_.id();
  status.goal_distance_m = goal_distance_m();
  const bool repairing = active_.kind() == PathKind::kRepair || active_.kind() == PathKind::kBacktrack;
  status.state = mode_ == Mode::kNoPath ? PlannerState::kNoPath
                 : repairing            ? PlannerState::kRepairing
                                        : PlannerState::kFollowing;
  if (leads_to_goal() && short_of_goal_m() > global_->goal_tolerance_m)
    status.text = "the goal is blocked: the path ends beside it";
  if (failures_ > 0 || mode_ == Mode::kNoPath) status.text = failure;
  const double hazard = hazard_ahead_m();
  const double unknown = unknown_ahead_m();
  status.blocked_in_m = std::max(0.0, std::min(hazard, unknown));
  status.block_kind = std::isinf(status.blocked_in_m) ? BlockKind::kNone
                      : hazard <= unknown             ? BlockKind::kHazard
                                                      : BlockKind::kUnseen;
  return status;
}

double PathPlanner::short_of_goal_m() const {
  return distance(active_.route().points().back().p, global_odom_->points().back().p);
}

bool PathPlanner::leads_to_goal() const {
  return mode_ != Mode::kBackingUp && active_.kind() != PathKind::kBacktrack &&
         short_of_goal_m() <= std::max(config_.planner.cost_to_go.blocked_goal_radius_m, global_->goal_tolerance_m);
}

// Beside the end of a path nothing of it is left, and still the goal may be far.
double PathPlanner::goal_distance_m() const {
  const bool leads = leads_to_goal();
  const Route& route = leads ? active_.route() : *global_odom_;
  const double along = route.length_m() - (leads ? active_.progress_m() : global_progress_m_);
  const double straight = distance(route.points().back().p, position(rover()));
  return along < kGoalNearM ? std::max(along, straight) : along;
}

}  // namespace rover::planning
