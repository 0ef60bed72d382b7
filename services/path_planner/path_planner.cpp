#include "path_planner/path_planner.hpp"

#include <cmath>

#include "common/core/path_limits.hpp"

namespace rover::planning {
namespace {

constexpr double kSearchBackM = 0.5;
constexpr double kSearchAheadM = 1.0;
constexpr double kKeepBehindM = 0.3;
constexpr double kStandingMps = 0.02;
constexpr double kTurnCreepMps = 0.05;  // of the body origin while the rover turns on the spot
constexpr double kStandingRadps = 0.02;
constexpr double kMaxCurvatureNow = 1.0;
constexpr double kCorridorReserveM = 0.05;
constexpr double kCellHalfM = 0.05;
constexpr double kGoalNearM = 1.0;
constexpr double kGainM = 1.0;     // of the global path, with which an attempt counts as a success
constexpr double kForgetM = 15.0;  // between the rover and a dead end
constexpr double kLeastRetreatM = 0.2;
constexpr double kRetreatEndM = 0.1;
constexpr int kMostRetreatsWanted = 2;
constexpr double kRetreatMarginM = 0.03;  // less than a way back over the own track has had
constexpr double kSamePlaceM = 1e-6;
constexpr int kFieldWork = 40;        // the travel field of a search costs as much time as that many expansions
constexpr size_t kPosesPerPoint = 2;  // repairs are verified every 5 cm and published every 10 cm

Pose2 inverse(const Pose2& T) {
  const double c = std::cos(T.yaw_rad);
  const double s = std::sin(T.yaw_rad);
  return {-c * T.x_m - s * T.y_m, s * T.x_m - c * T.y_m, -T.yaw_rad};
}

Point2 apply(const Pose2& T, Point2 p) {
  const double c = std::cos(T.yaw_rad);
  const double s = std::sin(T.yaw_rad);
  return {T.x_m + c * p.x_m - s * p.y_m, T.y_m + s * p.x_m + c * p.y_m};
}

double smooth_step(double u) {
  const double v = std::clamp(u, 0.0, 1.0);
  return v * v * (3.0 - 2.0 * v);
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
  return "";
}

PathPlanner::PathPlanner(const PathPlannerConfig& config, std::int64_t first_path_id, std::shared_ptr<PlanMaker> maker)
    : config_(config),
      local_repair_(config.repair),
      memory_(config.memory),
      ground_(config.full.map_cells, config.memory.cell_m, config.full.near_look_m),
      next_path_id_(first_path_id),
      maker_(std::move(maker)) {}

std::string PathPlanner::set_global_path(const GlobalPath& path) {
  if (const std::string fault = path.fault(); !fault.empty()) return fault;
  global_ = path;
  if (!(path.goal_tolerance_m > 0.0)) global_->goal_tolerance_m = config_.goal_tolerance_m;
  if (!(path.corridor_half_width_m > 0.0)) global_->corridor_half_width_m = config_.corridor_half_width_m;
  global_map_ = rounded(path.points, config_.rounding);
  forget_way();
  failures_ = 0;
  retreats_ = wanted_retreats_ = 0;
  dead_ends_.clear();
  furthest_m_ = horizon_from_m_ = 0.0;
  return "";
}

void PathPlanner::set_start_area(Point2 center_map, double radius_m, Utime utime) {
  start_area_ = StartArea{center_map, radius_m, utime};
}

void PathPlanner::add_pose(const PoseSample& sample) {
  if (!sample.usable) {
    history_.clear();  // what comes after need not fit to what was before
    driven_.clear();
    making_.reset();
    return;
  }
  history_.add(sample);
  take_start_area();
  memory_.move_to(position(rover()));
  if (full_level_) ground_.move_to(position(rover()));
  memory_.mark_driven(rover(), config_.footprint);
  track_driven_way();
}

void PathPlanner::track_driven_way() {
  if (active_.kind == PathKind::kRetreat)
    driven_.retrace(position(rover()));
  else
    driven_.extend(position(rover()));
}

void PathPlanner::take_start_area() {
  if (!start_area_ || history_.newest().utime <= start_area_->utime) return;
  const PoseSample newest = history_.newest();
  history_.clear();
  history_.add(newest);
  memory_.clear();
  ground_.clear();
  driven_.clear();
  dead_ends_.clear();
  memory_.move_to(position(rover()));
  const Point2 center = apply(inverse(planar(newest.T_map_odom)), start_area_->center_map);
  if (start_area_->radius_m > 0.0) memory_.mark_seen(center, start_area_->radius_m);
  start_area_.reset();
  forget_way();
  new_ground_ = true;
}

void PathPlanner::forget_way() {
  legs_.clear();
  retreat_wanted_ = false;
  global_odom_ = Route();
  active_ = Active();
  agenda_.restart();
  firm_agenda_.restart();
  making_.reset();
}

bool PathPlanner::add_hazards(const HazardGrid& grid) {
  const std::optional<Eigen::Isometry3d> T = history_.at(grid.utime);
  if (!T || !grid.fault().empty()) return false;
  memory_.add(grid, *T, config_.ground_z_m);
  new_ground_ = true;
  return true;
}

bool PathPlanner::ready(Utime now) const {
  return global_ && !history_.empty() && now - history_.newest().utime <= to_utime(config_.pose_max_age_s);
}

PlannerOutput PathPlanner::step(Utime now) {
  PlannerOutput out;
  now_ = now;
  if (ready(now)) {
    if (global_odom_.empty()) lay_global_path();
    if (making_) take_result(false, out);
    new_map_ = std::exchange(plan_waits_, false) || new_map_;
    if (active_.route.empty()) {
      if (failures_ == 0 || new_ground_) begin(out);
    } else {
      if (resumed_) send_again(out);
      track_progress();
      leave_repair(out);
      follow_correction(out);
      if (new_ground_ || new_map_) react(out);
    }
    new_ground_ = false;
    new_map_ = false;
  }
  out.status = status(now);
  return out;
}

void PathPlanner::lay_global_path() {
  T_map_odom_laid_ = planar(history_.newest().T_map_odom);
  global_odom_ = transformed(global_map_, inverse(T_map_odom_laid_));
  global_progress_m_ = global_odom_.closest(position(rover()));
  if (!making_) return;
  making_.reset();  // it leads back to where the path lay
  plan_waits_ = true;
}

void PathPlanner::send_again(PlannerOutput& out) {
  resumed_ = false;
  out.path = published();
}

LocalPath PathPlanner::published() const {
  return {active_.id, active_.kind, active_.corridor_half_width_m, global_->goal_tolerance_m, active_.route.points()};
}

void PathPlanner::track_progress() {
  const Point2 p = position(rover());
  active_.progress_m = active_.route.closest(p, active_.progress_m - kSearchBackM, active_.progress_m + kSearchAheadM);
  global_progress_m_ =
      global_odom_.closest(p, global_progress_m_ - 3.0 * kSearchAheadM, global_progress_m_ + 3.0 * kSearchAheadM);
  horizon_from_m_ = std::max(horizon_from_m_, global_progress_m_);
  if (global_progress_m_ < furthest_m_ + kGainM) return;
  furthest_m_ = global_progress_m_;
  retreats_ = wanted_retreats_ = 0;
  std::erase_if(dead_ends_, [&](const DeadEnd& end) { return distance(end.p, p) > kForgetM; });
}

void PathPlanner::begin(PlannerOutput& out) {
  const Point2 start = global_odom_.point_at(global_progress_m_);
  if (distance(start, position(rover())) > config_.max_start_offset_m) {
    if (continuous()) return want_plan({}, out);
    repair(false, out);
    return;
  }
  active_.margin_m = config_.margin_m;
  active_.corridor_half_width_m = global_->corridor_half_width_m;
  std::vector<RoutePoint> points;
  const size_t next = global_odom_.vertex_after(global_progress_m_);
  if (next < global_odom_.points().size())
    points.push_back({start, global_progress_m_, global_odom_.level_at(global_progress_m_)});
  else
    points.push_back(global_odom_.points()[next - 2]);  // the rover stands at the end: the last piece is the path
  for (size_t i = std::min(next, global_odom_.points().size() - 1); i < global_odom_.points().size(); ++i)
    points.push_back(global_odom_.points()[i]);
  adopt(Route(std::move(points)), PathKind::kGlobal, out);
  judge();
}

// A new frame: is the way still free, and if not, is there another?
void PathPlanner::react(PlannerOutput& out) {
  if (!legs_.empty() && !continuous()) give_up_manoeuvre();
  if (retreat_wanted_ && retreat_as_wanted(out)) return;
  if (on_manoeuvre()) {
    go_on_manoeuvre(out);
    if (!legs_.empty() || out.path) return;
  }
  if (active_.kind == PathKind::kRetreat) return look_from_retreat(out);
  if (continuous()) return go_on(out);
  judge();
  // A single hit that stays in the way without being seen again counts as a hazard in the end.
  frames_before_possible_ = hazard_ahead_m() < config_.stop_hazard_m ? frames_before_possible_ + 1 : 0;
  const bool blocked =
      block_.confirmed_m - active_.progress_m < config_.trigger_m || frames_before_possible_ >= config_.patience_frames;
  const bool before_unseen = (unseen_ahead_m() < config_.stop_unseen_m || strayed()) && standing();
  frames_before_unseen_ = before_unseen ? frames_before_unseen_ + 1 : 0;
  if (blocked || frames_before_unseen_ >= config_.patience_frames) {
    if (repair(blocked, out)) frames_before_unseen_ = 0;
  } else {
    failures_ = 0;
    agenda_.restart();
    if (active_.kind == PathKind::kRepair) firm_up(out);
  }
  if (stuck() && standing()) retreat(out);
}

bool PathPlanner::in_the_way() const {
  return hazard_ahead_m() < config_.stop_hazard_m || unseen_ahead_m() < config_.stop_unseen_m;
}

bool PathPlanner::stuck() const {
  return (in_the_way() || strayed()) && failures_ >= config_.patience_frames;
}

// Outside the corridor, or about to leave it, the rover is not let on (supervisor): only another path helps.
bool PathPlanner::strayed() const {
  return replan_wanted_ ||
         distance(active_.route.point_at(active_.progress_m), position(rover())) > active_.corridor_half_width_m;
}

// No way leads on from here, but one led here: back over ground that carried the rover, to where more can be seen and
// there is room to turn; further each time, and what led here costs more from now on. False where there is no track, or
// where that has been tried enough.
bool PathPlanner::retreat(PlannerOutput& out) {
  if (retreats_ >= (continuous() ? config_.full.most_retreats : config_.most_retreats)) return false;
  dead_ends_.push_back({position(rover()), config_.repair.dead_end_cost});
  std::vector<Point2> back = driven_.back(position(rover()), (1 + retreats_) * config_.retreat_m);
  if (continuous()) back = way_back(back);
  if (back.size() < 2 || distance(back.front(), back.back()) < kLeastRetreatM) {
    dead_ends_.pop_back();
    return false;
  }
  ++retreats_;
  failures_ = 0;
  legs_.clear();
  turning_ = false;  // whatever turn was begun, the rover backs out of it
  std::vector<RoutePoint> points;
  for (const Point2& p : back) points.push_back({p, kNaN, global_odom_.level_at(global_progress_m_)});
  active_.corridor_half_width_m = config_.retreat_corridor_m;
  adopt(Route(std::move(points)), PathKind::kRetreat, out);
  active_.retreat_from = rover();
  block_ = Block();
  return true;
}

// At its end, or where the rover is not let on along it: on a slope it may slide towards a rock beside its track.
// Behind it nothing looks, so what was seen once or never does not count.
void PathPlanner::look_from_retreat(PlannerOutput& out) {
  judge();
  block_.possible_m = block_.unseen_m = kInfinity;
  const bool blocked = hazard_ahead_m() < config_.stop_hazard_m;
  if (!standing() || !(at_retreat_end() || strayed() || blocked)) return;
  if (continuous()) return want_plan({}, out);
  if (repair(true, out) || failures_ < config_.patience_frames) return;
  retreat(out);
}

// More of them without new ground gained help neither a camera nor a slope.
bool PathPlanner::retreat_as_wanted(PlannerOutput& out) {
  if (!standing() || wanted_retreats_ >= kMostRetreatsWanted || !retreat(out)) return false;
  ++wanted_retreats_;
  return true;
}

// A track that was driven to and fro lies twice in one place, and progress may be taken for that of the first.
bool PathPlanner::at_retreat_end() const {
  const double left_m = active_.route.length_m() - active_.progress_m;
  const double straight_m = distance(active_.route.points().back().p, position(rover()));
  return left_m <= kRetreatEndM || (left_m <= kSearchAheadM && straight_m <= kRetreatEndM);
}

// Repairs are sure for their first metres only. Where the rest does not become so on approach, another way is sought
// while there is room; not during a point turn, which shows new ground by itself.
void PathPlanner::firm_up(PlannerOutput& out) {
  if (turning_) return;
  const Terrain terrain(memory_);
  std::vector<Pose2> poses = {rover()};
  for (double s = active_.progress_m + kPoseStepM; s < active_.repair_end_m; s += kPoseStepM)
    poses.push_back(active_.route.pose_at(s));
  const double sure = seen_way(terrain, poses);
  if (sure >= config_.firm_way_m) return;
  if (search(terrain, {{kInfinity, goal_reach_m()}, {config_.sure_way_m, goal_reach_m()}}, firm_agenda_) !=
      SearchEnd::kFound)
    return;
  if (seen_way(terrain, last_repair_.poses) > sure + config_.firm_gain_m) take_repair(out);
}

double PathPlanner::seen_way(const Terrain& terrain, const std::vector<Pose2>& poses) const {
  return seen_way_m(poses, FootprintCheck(terrain, config_.footprint, active_.margin_m, 0.0, rover()),
                    config_.repair.view);
}

// A turn goes on below the error that starts one. Were the rover taken for one that drives off at that error, its path
// would look blocked in the middle of each turn beside a rock, and the next plan would turn it back.
void PathPlanner::track_turn(const Pose2& heading_on) {
  const double error = std::abs(wrap_angle(active_.route.pose_at(active_.progress_m).yaw_rad - heading_on.yaw_rad));
  const bool driving = std::abs(history_.newest().forward_mps) > kTurnCreepMps;
  turning_ = error > config_.turn_threshold_rad || (turning_ && error > config_.turn_stop_rad && !driving);
}

void PathPlanner::judge() {
  Pose2 heading_on = rover();
  if (active_.kind == PathKind::kRetreat)
    heading_on.yaw_rad = wrap_angle(heading_on.yaw_rad + kPi);  // the rectangle looks the same from behind
  track_turn(heading_on);
  const double margin_m = active_.retreat_from ? kRetreatMarginM : active_.margin_m + sigma_margin_m();
  const Terrain ground = terrain();
  block_ = find_block({ground, active_.route, config_.footprint, active_.progress_m, heading_on, margin_m, turning_,
                       config_.turn_threshold_rad, active_.retreat_from});
}

bool PathPlanner::repair(bool because_of_hazard, PlannerOutput& out) {
  const SearchEnd end = search(Terrain(memory_), demands(), agenda_);
  if (end != SearchEnd::kFound) {
    // A frame whose search goes on is one of patience, but none that ends it.
    if (end == SearchEnd::kNone || failures_ + 1 < config_.patience_frames) ++failures_;
    return false;
  }
  failures_ = 0;
  if (because_of_hazard) ++replans_;
  take_repair(out);
  return true;
}

// They fall from one to the next. The last is for a goal under hazards, once that is certain.
std::vector<WayDemand> PathPlanner::demands() const {
  std::vector<WayDemand> out;
  for (const double sure_m : {kInfinity, config_.sure_way_m, config_.least_sure_way_m})
    out.push_back({sure_m, goal_reach_m()});
  if (failures_ + 1 >= config_.patience_frames && goal_near())
    out.push_back({config_.sure_way_m, config_.blocked_goal_reach_m});
  return out;
}

bool PathPlanner::goal_near() const {
  return distance(global_odom_.points().back().p, position(rover())) < config_.repair.view.far_m;
}

PathPlanner::SearchEnd PathPlanner::search(const Terrain& terrain, const std::vector<WayDemand>& demands,
                                           RepairAgenda& agenda) {
  const std::vector<LeadIn> leads = lead_ins();
  agenda.fit(demands.size());
  for (int work = 0; work < config_.frame_work; work += last_repair_.expansions + kFieldWork) {
    last_lead_ = leads[std::min(agenda.lead(), leads.size() - 1)];
    last_margin_m_ = agenda.margin() == 0 ? config_.margin_m : config_.tight_margin_m;
    last_repair_ = plan_repair(terrain, last_lead_, last_margin_m_, demands[agenda.demand()]);
    if (last_repair_.status == RepairStatus::kFound) {
      agenda.restart();
      return SearchEnd::kFound;
    }
    if (!agenda.advance(last_repair_.status, demands, leads.size())) return SearchEnd::kNone;
  }
  return SearchEnd::kGoesOn;
}

// At speed the wheels need time to steer: the repair bends where the rover can have slowed down. Only where that leaves
// no way it bends at once.
std::vector<PathPlanner::LeadIn> PathPlanner::lead_ins() const {
  const PoseSample& now = history_.newest();
  if (now.forward_mps < kStandingMps) return {{}};
  const double curvature = std::clamp(now.yaw_rate_radps / now.forward_mps, -kMaxCurvatureNow, kMaxCurvatureNow);
  const double reaction = now.forward_mps * config_.release_latency_s;
  const double braking = 0.5 * now.forward_mps * now.forward_mps / config_.deceleration_mps2;
  if (braking < kPoseStepM) return {{reaction + braking, curvature}};
  return {{reaction + braking, curvature}, {reaction, curvature}};
}

void PathPlanner::take_repair(PlannerOutput& out) {
  legs_.clear();
  active_.margin_m = last_margin_m_;
  active_.corridor_half_width_m =
      std::clamp(last_repair_.clearance_m - kCellHalfM - kCorridorReserveM, config_.least_corridor_m,
                 std::max(config_.least_corridor_m, global_->corridor_half_width_m));
  adopt(repaired_route(last_repair_), PathKind::kRepair, out);
  judge();
}

RepairResult PathPlanner::plan_repair(const Terrain& terrain, const LeadIn& lead, double margin_m,
                                      const WayDemand& demand) const {
  const double halt_m = lead_ins().front().way_m;
  return local_repair_.plan(
      {terrain, global_odom_, global_progress_m_, advanced(rover(), lead.way_m, lead.curvature_per_m),
       lead.curvature_per_m, advanced(rover(), halt_m, lead.curvature_per_m),
       margin_m + config_.plan_extra_m + sigma_margin_m(), demand.sure_m, demand.goal_reach_m, dead_ends_});
}

Route PathPlanner::repaired_route(const RepairResult& repair) const {
  std::vector<RoutePoint> points;
  for (double way = 0.0; way < last_lead_.way_m - kPoseStepM; way += 2.0 * kPoseStepM)
    points.push_back({position(advanced(rover(), way, last_lead_.curvature_per_m)), kNaN,
                      global_odom_.level_at(global_progress_m_)});
  append_poses(repair.poses, repair.join_m, points);
  for (size_t i = global_odom_.vertex_after(repair.join_m + 0.5 * config_.rounding.step_m);
       i < global_odom_.points().size(); ++i)
    points.push_back(global_odom_.points()[i]);
  return Route(std::move(points));
}

void PathPlanner::append_poses(const std::vector<Pose2>& poses, double end_station_m,
                               std::vector<RoutePoint>& points) const {
  for (size_t i = 0; i < poses.size(); ++i) {
    const bool halt = i > 0 && distance(position(poses[i - 1]), position(poses[i])) < kSamePlaceM;
    const bool halt_next = i + 1 < poses.size() && distance(position(poses[i]), position(poses[i + 1])) < kSamePlaceM;
    if (halt || (i % kPosesPerPoint != 0 && !halt_next && i + 1 != poses.size())) continue;
    const double share = static_cast<double>(i) / static_cast<double>(poses.size() - 1);
    const double along = global_progress_m_ + share * (end_station_m - global_progress_m_);
    points.push_back({position(poses[i]), kNaN, global_odom_.level_at(along)});
  }
}

void PathPlanner::adopt(Route route, PathKind kind, PlannerOutput& out) {
  active_.route = std::move(route);
  active_.kind = kind;
  active_.id = next_path_id_++;
  active_.retreat_from.reset();
  replan_wanted_ = false;
  retreat_wanted_ = false;
  no_way_on_ = false;
  agenda_.restart();
  firm_agenda_.restart();
  active_.progress_m = active_.route.closest(position(rover()), 0.0, kSearchAheadM);
  active_.repair_end_m = 0.0;
  for (size_t i = 0; i < active_.route.points().size(); ++i)
    if (std::isnan(active_.route.points()[i].global_s_m)) active_.repair_end_m = active_.route.s_at(i);
  out.path = published();
}

// Past the place where the global path is joined the path is the global path again, with its own corridor.
void PathPlanner::leave_repair(PlannerOutput& out) {
  if (active_.kind != PathKind::kRepair || active_.progress_m <= active_.repair_end_m) return;
  std::vector<RoutePoint> rest;
  const std::vector<RoutePoint>& points = active_.route.points();
  const size_t first = active_.route.vertex_after(active_.progress_m - kKeepBehindM);
  for (size_t i = first > 0 ? first - 1 : 0; i < points.size(); ++i) rest.push_back(points[i]);
  if (rest.size() < 2) return;
  const double shift = active_.route.s_at(first > 0 ? first - 1 : 0);
  active_.corridor_half_width_m = global_->corridor_half_width_m;
  adopt(Route(std::move(rest)), PathKind::kGlobal, out);
  block_ = {block_.confirmed_m - shift, block_.possible_m - shift, block_.unseen_m - shift};
}

// Map has moved against odom: obstacles stay, the global path's part of the active path moves, at bounded curvature and
// not before the rover has left a repair.
void PathPlanner::follow_correction(PlannerOutput& out) {
  const Pose2 T_now = planar(history_.newest().T_map_odom);
  const Point2 ahead = apply(T_map_odom_laid_, active_.route.point_at(active_.progress_m + 10.0));
  const Point2 here = apply(T_map_odom_laid_, position(rover()));
  const Pose2 T_odom_map = inverse(T_now);
  const Pose2 T_odom_map_laid = inverse(T_map_odom_laid_);
  const auto moved = [&](Point2 p_map) { return distance(apply(T_odom_map, p_map), apply(T_odom_map_laid, p_map)); };
  const double change = std::max(moved(here), moved(ahead));
  if (change < config_.correction_m) return;
  lay_global_path();
  if (active_.kind == PathKind::kRetreat) return;  // over the driven track, which lies in odom
  const double begin = std::max(active_.progress_m + 1.0, active_.repair_end_m);
  // Of the blend 3u^2 - 2u^3: slope at most 0.33, curvature at most 0.3 per metre.
  const double ramp = std::max({3.0, 4.5 * change, std::sqrt(20.0 * change)});
  std::vector<RoutePoint> points = active_.route.points();
  for (size_t i = 0; i < points.size(); ++i) {
    if (std::isnan(points[i].global_s_m)) continue;
    const Point2 target = global_odom_.point_at(points[i].global_s_m);
    const double w = smooth_step((active_.route.s_at(i) - begin) / ramp);
    points[i].p = {points[i].p.x_m + w * (target.x_m - points[i].p.x_m),
                   points[i].p.y_m + w * (target.y_m - points[i].p.y_m)};
  }
  const double progress = active_.progress_m;
  adopt(Route(std::move(points)), active_.kind, out);
  active_.progress_m = active_.route.closest(position(rover()), progress - kSearchBackM, progress + kSearchAheadM);
  judge();
}

double PathPlanner::sigma_margin_m() const {
  if (continuous()) return config_.full.sigma_margin_m;
  return std::min(config_.most_sigma_margin_m, config_.sigma_gain * history_.gained_sigma_m());
}

bool PathPlanner::standing() const {
  return std::abs(history_.newest().forward_mps) < kStandingMps &&
         std::abs(history_.newest().yaw_rate_radps) < kStandingRadps;
}

double PathPlanner::hazard_ahead_m() const {
  if (no_way_on_) return 0.0;
  return std::min(block_.confirmed_m, block_.possible_m) - active_.progress_m;
}

PlannerStatus PathPlanner::status(Utime now) const {
  PlannerStatus status;
  status.replans = replans_;
  if (global_) status.global_path_id = global_->id;
  if (!ready(now)) {
    status.text = global_ ? "no fresh pose" : "no global path";
    return status;
  }
  if (!global_odom_.empty())
    status.corridor_offset_m = distance(global_odom_.point_at(global_progress_m_), position(rover()));
  if (active_.route.empty()) {
    status.state = PlannerState::kNoPath;
    status.text = std::string("cannot reach the global path: ") + text_of(last_repair_.status);
    return status;
  }
  status.path_id = active_.id;
  status.goal_distance_m = goal_distance_m();
  const bool off_plan = active_.kind == PathKind::kRepair || active_.kind == PathKind::kRetreat;
  status.state = off_plan ? PlannerState::kRepairing : PlannerState::kFollowing;
  if (leads_to_goal() && short_of_goal_m() > global_->goal_tolerance_m)
    status.text = "the goal is blocked: the path ends beside it";
  describe_block(status);
  return status;
}

void PathPlanner::describe_block(PlannerStatus& status) const {
  const double hazard = hazard_ahead_m();
  const double unseen = unseen_ahead_m();
  status.blocked_in_m = std::max(0.0, std::min(hazard, unseen));
  status.block_kind = std::isinf(status.blocked_in_m) ? BlockKind::kNone
                      : hazard <= unseen              ? BlockKind::kHazard
                                                      : BlockKind::kUnseen;
  if (failures_ == 0) return;
  status.text = text_of(last_repair_.status);
  const bool no_way = active_.kind == PathKind::kRetreat ? failures_ >= config_.patience_frames : stuck();
  if (no_way) status.state = PlannerState::kNoPath;
}

double PathPlanner::short_of_goal_m() const {
  return distance(active_.route.points().back().p, global_odom_.points().back().p);
}

// Ways back and the legs of a manoeuvre do not.
bool PathPlanner::leads_to_goal() const {
  return active_.kind != PathKind::kRetreat &&
         short_of_goal_m() <= std::max(config_.blocked_goal_reach_m, global_->goal_tolerance_m);
}

// Beside the way's end nothing of it is left, and still the goal may be far.
double PathPlanner::goal_distance_m() const {
  const bool leads = leads_to_goal();
  const Route& way = leads ? active_.route : global_odom_;
  const double along = way.length_m() - (leads ? active_.progress_m : global_progress_m_);
  const double straight = distance(way.points().back().p, position(rover()));
  return along < kGoalNearM ? std::max(along, straight) : along;
}

}  // namespace rover::planning
