// The planner at the Full level: a plan with each new map, and when a hazard blocks the one that is being driven.
#include <array>
#include <cmath>

#include "path_planner/path_planner.hpp"

namespace rover::planning {
namespace {

constexpr double kBehindM = 0.3;
constexpr double kChordM = 0.15;
constexpr double kPastKinkM = 0.2;
constexpr double kLeastHeldM = 0.3;
constexpr double kLeadM = 0.25;  // of the way being driven, with which a new plan begins
constexpr double kHalfCellM = 0.05;
constexpr double kControlM = 0.05;
constexpr double kMostBackM = 4.0;    // further back the goal line leaves the ground that is remembered
constexpr double kLeastHaltM = 0.1;   // shorter ways to a halt are none
constexpr double kManoeuvreM = 1.5;   // to a change of direction: nearer, the plan is not changed any more
constexpr double kBackRadiusM = 2.0;  // of the way from a plan's end back to the global path
constexpr double kBackReserveM = 0.1;
constexpr double kBackMarginM = 0.05;  // the rover has been there
constexpr double kBackTurnStepRad = 0.1;
constexpr double kBackTurnRad = 0.35;        // more between stern and track needs room to turn
constexpr double kLeastStraightBackM = 0.2;  // so little may free the bow to turn
constexpr double kBackAheadM = 3.0;
// Between rocks at bow and flank: turns on the spot after which the rover may go straight back.
constexpr std::array<double, 6> kTurnsBackDeg = {45.0, -45.0, 60.0, -60.0, 75.0, -75.0};
constexpr double kCreepMps = 0.05;  // of the body origin while the rover turns on the spot
constexpr double kAtKinkM = 0.15;
constexpr double kTurnBlockM = 1.5;     // likewise while the rover turns on the spot
constexpr double kDetourM = 1.5;        // by which a closed gap makes the way dearer, and so is worth remembering
constexpr double kNearPossibleM = 1.5;  // nearer ones that stay are planned around
constexpr double kAsideM = 0.5;         // by which a way past a single hit may be longer
constexpr double kNearBlockM = 3.5;     // nearer blocks are planned for at once, others with the next map

double length_m(const std::vector<Pose2>& poses) {
  double sum = 0.0;
  for (size_t i = 1; i < poses.size(); ++i) sum += distance(position(poses[i - 1]), position(poses[i]));
  return sum;
}

// Whether the rectangle is clear at the second pose, and on the turn to its heading.
bool clear_turn(const FootprintCheck& check, const Pose2& from, const Pose2& to) {
  const double turn = wrap_angle(to.yaw_rad - from.yaw_rad);
  const int steps = 1 + static_cast<int>(std::abs(turn) / kBackTurnStepRad);
  for (int i = 1; i <= steps; ++i)
    if (!check.clear({to.x_m, to.y_m, from.yaw_rad + turn * i / steps})) return false;
  return true;
}

}  // namespace

void PathPlanner::set_level(bool full) {
  if (full_level_ && !full) {
    if (!legs_.empty()) give_up_manoeuvre();
    map_utime_ = kNever;
    ground_.clear();
    new_map_ = false;
    no_way_on_ = false;
    // The rest of the plan is driven as a repair is: the global path follows.
    if (active_.kind == PathKind::kContinuous) active_.kind = PathKind::kRepair;
  }
  if (full_level_ != full) making_.reset();
  full_level_ = full;
}

bool PathPlanner::add_traversability(const TraversabilityGrid& map) {
  if (!full_level_ || !map.fault().empty() || history_.empty()) return false;
  ground_.move_to(position(rover()));
  ground_.add(map, position(rover()));
  ground_.add(memory_);
  map_utime_ = map.utime;
  map_travelled_m_ = history_.newest().travelled_m;
  new_map_ = true;
  return true;
}

// A map stays true while the rover stands; driven away from, it has to be followed by another one.
bool PathPlanner::continuous() const {
  if (!full_level_ || map_utime_ == kNever || history_.empty()) return false;
  const PoseSample& now = history_.newest();
  const bool old = now.utime - map_utime_ > to_utime(config_.full.stale_s);
  return !(old && now.travelled_m - map_travelled_m_ > config_.full.stale_way_m);
}

void PathPlanner::go_on(PlannerOutput& out) {
  judge();
  const bool turning = at_turn();
  const bool halted = halted_before_block();
  const bool blocked =
      no_way_on_ || halted || block_.confirmed_m - active_.progress_m < (turning ? kTurnBlockM : kNearBlockM);
  const bool ends_early = legs_.empty() && !leads_to_goal();  // the legs that followed were given up
  const bool wanted = (new_map_ && !turning) || active_.kind != PathKind::kContinuous || ends_early;
  if (!blocked && !wanted) {
    failures_ = 0;
    if (!turning && in_the_way()) want_plan({}, out, true);
    return;
  }
  // One map may show a gap closed that the next one opens; the plan's first metres are free meanwhile.
  want_plan(closed_gap(), out);
}

std::optional<PathPlanner::ClosedGap> PathPlanner::closed_gap() const {
  const bool closed = active_.kind == PathKind::kContinuous && block_.confirmed_m - active_.progress_m < kNearBlockM;
  if (!closed) return std::nullopt;
  return ClosedGap{active_.route.point_at(std::min(block_.confirmed_m, active_.route.length_m())),
                   active_.cost - (active_.progress_m - active_.cost_at_m)};
}

// All legs together.
double PathPlanner::way_left_m() const {
  if (legs_.empty()) return goal_distance_m();
  double way_m = active_.route.length_m() - active_.progress_m + global_odom_.length_m() - legs_end_m_;
  for (const CurveLeg& leg : legs_) way_m += length_m(leg.poses);
  return way_m;
}

// It is tried again where all other ways are dearer by more than the one that was taken instead, twice that the second
// time. By cost, as plans are chosen: the other way may be shorter.
void PathPlanner::note_closed_gap(const ClosedGap& gap, const FullPlan& plan) {
  const double reach_m = config_.repair.dead_end_reach_m;
  const bool past_it = std::any_of(plan.plan.poses.begin(), plan.plan.poses.end(),
                                   [&](const Pose2& pose) { return distance(position(pose), gap.p) < reach_m; });
  const double detour = plan.cost - gap.cost_left;
  if (past_it || detour < kDetourM) return;
  dead_ends_.push_back({gap.p, std::max(config_.repair.dead_end_cost, detour / (2.0 * reach_m))});
}

// A single hit that is neither confirmed nor cleared on approach is planned around before the rover is stopped by it,
// unseen ground when it has stopped the rover.
bool PathPlanner::halted_before_block() {
  frames_before_possible_ = hazard_ahead_m() < kNearPossibleM ? frames_before_possible_ + 1 : 0;
  const bool before_unseen = (unseen_ahead_m() < config_.stop_unseen_m || strayed()) && standing();
  frames_before_unseen_ = before_unseen ? frames_before_unseen_ + 1 : 0;
  return std::max(frames_before_possible_, frames_before_unseen_) >= config_.patience_frames;
}

// While the rover turns on the spot it is left to finish that: each plan made of a view on the way would begin another
// turn, to and fro.
bool PathPlanner::at_turn() const {
  if (std::abs(history_.newest().forward_mps) > kCreepMps) return false;
  const std::vector<size_t>& kinks = active_.route.kinks();
  return turning_ || std::any_of(kinks.begin(), kinks.end(), [&](size_t i) {
           return std::abs(active_.route.s_at(i) - active_.progress_m) < kAtKinkM;
         });
}

// A plan that was begun before the way was blocked nearby does not know of that: another one presses.
void PathPlanner::want_plan(const std::optional<ClosedGap>& closed, PlannerOutput& out, bool aside) {
  const bool pressing = in_the_way();
  if (making_ && (making_->pressing || !pressing)) {
    making_->again = true;
    return;
  }
  auto job = std::make_shared<PlanJob>(config_.full, memory_, ground_, global_odom_, dead_ends_);
  fill(job->request());
  if (!maker_->start(job, now_)) {
    (making_ ? making_->again : plan_waits_) = true;
    return;
  }
  making_ = Making{std::move(job), active_.id, turning_, closed, pressing, aside};
  take_result(pressing, out);
}

void PathPlanner::take_result(bool pressing, PlannerOutput& out) {
  const std::optional<FullPlan> plan = maker_->result(now_, pressing);
  if (!plan) return;
  const Making made = *std::exchange(making_, std::nullopt);
  const bool of_use = still_of_use(made);
  plan_waits_ = made.again || !of_use;
  if (!of_use || (made.aside && !leads_aside(*plan))) return;
  if (!plan->plan.found) return go_without(*plan, out);
  last_repair_.status = RepairStatus::kFound;
  take_plan(*plan, made.job->request(), out);
  frames_before_unseen_ = 0;
  // A plan on which the rover is not let go is none.
  failures_ = hazard_ahead_m() < config_.stop_hazard_m ? failures_ + 1 : 0;
  // A gap that was found closed from near may look open again from afar: without this the rover goes to and fro.
  if (made.closed) note_closed_gap(*made.closed, *plan);
  retreat_if_stuck(out);
}

bool PathPlanner::still_of_use(const Making& making) const {
  return continuous() && making.path_id == active_.id && making.turning == turning_;
}

// The next frame as often as not takes a single hit back: nothing is given up for it.
bool PathPlanner::leads_aside(const FullPlan& plan) const {
  if (!plan.plan.found || plan.plan.halts > 0 || plan.plan.backs_first) return false;
  const double way_m = length_m(plan.plan.poses) + global_odom_.length_m() - plan.end_station_m;
  return way_m < way_left_m() + kAsideM;
}

void PathPlanner::go_without(const FullPlan& none, PlannerOutput& out) {
  last_repair_.status = none.plan.unseen_in_the_way ? RepairStatus::kUnseen : RepairStatus::kNoWay;
  ++failures_;
  if (active_.kind == PathKind::kContinuous) no_way_on_ = failures_ >= config_.patience_frames;
  if (active_.kind != PathKind::kRetreat) return retreat_if_stuck(out);
  if (failures_ >= config_.patience_frames) retreat(out);
}

void PathPlanner::retreat_if_stuck(PlannerOutput& out) {
  if (active_.route.empty() || !stuck() || !standing()) return;
  ground_.doubt_closed();
  retreat(out);
}

void PathPlanner::fill(FullRequest& request) const {
  const LeadIn halt = lead_ins().front();
  const double late_m = std::max(0.0, history_.newest().forward_mps) * config_.full.latency_s;
  const double curvature = standing() ? 0.0 : halt.curvature_per_m;
  const double sigma = sigma_margin_m();
  const bool any_goal = failures_ + 1 >= config_.patience_frames && goal_near();
  request.footprint = config_.footprint;
  request.view = config_.repair.view;
  request.from_m = global_progress_m_;
  // Were the goal line to come and go with the rover, so would what blocks the ways to it: it went to and fro between
  // two of them until its time was over.
  request.back_m = std::clamp(horizon_from_m_ - global_progress_m_, 0.0, kMostBackM);
  request.rover = rover();
  request.start = advanced(rover(), lead_to_plan().way_m + late_m, curvature);
  request.stopped = advanced(rover(), halt.way_m + late_m, curvature);
  request.start_curvature_per_m = curvature;
  request.turning = turning_;
  request.held = held_way();
  request.roomy_margin_m = config_.margin_m + config_.plan_extra_m + sigma;
  request.tight_margin_m = config_.tight_margin_m + sigma;
  request.squeeze_margin_m = config_.full.squeeze_margin_m + sigma;
  request.turn_margin_m = config_.tight_margin_m + config_.full.turn_extra_m + sigma;
  request.goal_reach_m = any_goal ? config_.blocked_goal_reach_m : goal_reach_m();
}

// Where the block is nearer than the rover can halt, a plan bends away at once.
PathPlanner::LeadIn PathPlanner::lead_to_plan() const {
  const std::vector<LeadIn> leads = lead_ins();
  return hazard_ahead_m() < leads.front().way_m ? leads.back() : leads.front();
}

// Arc length to which the active plan is kept where it is held: past a halt that lies there.
double PathPlanner::held_end_m() const {
  double end = active_.progress_m + config_.full.hold_m;
  for (const size_t i : active_.route.kinks())
    if (std::abs(active_.route.s_at(i) - end) < kPastKinkM) end = active_.route.s_at(i) + kPastKinkM;
  return std::min(end, active_.repair_end_m);
}

std::optional<HeldWay> PathPlanner::held_way() const {
  if (active_.kind != PathKind::kContinuous || active_.route.empty() || replan_wanted_) return std::nullopt;
  const double end = held_end_m();
  const double blocked = std::min({block_.confirmed_m, block_.possible_m, block_.unseen_m});
  if (end - active_.progress_m < kLeastHeldM || blocked < end || strayed()) return std::nullopt;
  HeldWay held;
  held.end_m = end;
  for (double s = active_.progress_m; s < end; s += kPoseStepM) held.poses.push_back(active_.route.pose_at(s));
  held.poses.push_back(active_.route.pose_at(end));
  for (const size_t i : active_.route.kinks()) {
    if (active_.route.s_at(i) <= active_.progress_m || active_.route.s_at(i) >= end) continue;
    held.turn_left_rad += std::abs(wrap_angle(active_.route.yaw_out_of(i) - active_.route.yaw_into(i)));
    ++held.halts;
  }
  if (turning_)
    held.turn_left_rad += std::abs(wrap_angle(active_.route.pose_at(active_.progress_m).yaw_rad - rover().yaw_rad));
  const double before = active_.route.pose_at(end - kChordM).yaw_rad;
  const double most = config_.full.search.max_curvature_per_m;
  held.end_curvature_per_m = std::clamp(wrap_angle(held.poses.back().yaw_rad - before) / kChordM, -most, most);
  return held;
}

// The driven track, as far as the rectangle passes it; where that begins with a turn, straight back over known ground
// if that is free: there may be no room to turn. Where neither leads anywhere, straight back after a turn on the spot.
std::vector<Point2> PathPlanner::way_back(const std::vector<Point2>& track) const {
  const double way_m = (1 + retreats_) * config_.retreat_m;
  const std::vector<Point2> straight = straight_back(rover(), way_m);
  const double straight_m = distance(straight.front(), straight.back());
  const std::vector<Point2> along = track.size() < 2 ? track : clear_part(track);
  const bool short_track = along.size() < 2 || distance(along.front(), along.back()) < kLeastStraightBackM;
  if (short_track && straight_m < kLeastStraightBackM) return turned_back(way_m);
  const bool turns =
      short_track ||
      std::abs(wrap_angle(rover().yaw_rad + kPi -
                          std::atan2(along[1].y_m - along[0].y_m, along[1].x_m - along[0].x_m))) > kBackTurnRad;
  return turns && straight_m >= kLeastStraightBackM ? straight : along;
}

std::vector<Point2> PathPlanner::turned_back(double way_m) const {
  const Terrain ground = terrain();
  const FootprintCheck check(ground, config_.footprint, kBackMarginM, 0.0, rover());
  std::vector<Point2> best;
  for (const double turn_deg : kTurnsBackDeg) {
    const Pose2 turned{rover().x_m, rover().y_m, rover().yaw_rad + to_rad(turn_deg)};
    if (!clear_turn(check, rover(), turned)) continue;
    const std::vector<Point2> back = straight_back(turned, way_m);
    if (back.size() > best.size()) best = back;
  }
  return best;
}

std::vector<Point2> PathPlanner::straight_back(const Pose2& from, double way_m) const {
  const Terrain ground = terrain();
  const FootprintCheck check(ground, config_.footprint, config_.full.squeeze_margin_m, 0.0, rover());
  std::vector<Point2> out = {position(from)};
  for (double s = kPoseStepM; s <= way_m; s += kPoseStepM) {
    const Pose2 pose = advanced(from, -s, 0.0);
    if (!check.clear(pose) || !check.all_unseen(pose, [](Point2) { return false; })) break;
    out.push_back(position(pose));
  }
  return out;
}

// Of the way back, what the rectangle surely passes, stern first: whether the rover turns to the track's heading at
// once or, as the block test has it, on the way. A way back that this test stops would be taken again and again.
std::vector<Point2> PathPlanner::clear_part(const std::vector<Point2>& back) const {
  std::vector<RoutePoint> points;
  for (const Point2& p : back) points.push_back({p});
  const Route route(std::move(points));
  const Terrain ground = terrain();
  const FootprintCheck check(ground, config_.footprint, kBackMarginM, 0.0, rover());
  const Pose2 astern{rover().x_m, rover().y_m, wrap_angle(rover().yaw_rad + kPi)};
  const bool turning = std::abs(wrap_angle(route.pose_at(0.0).yaw_rad - astern.yaw_rad)) > config_.turn_threshold_rad;
  const Block block = find_block(
      {ground, route, config_.footprint, 0.0, astern, kBackMarginM, turning, config_.turn_threshold_rad, rover()});
  double clear_m = std::min(route.length_m(), block.confirmed_m - kBackReserveM);
  Pose2 before = rover();
  for (double s = 0.0; s < clear_m; s += kPoseStepM) {
    Pose2 pose = route.pose_at(s);
    pose.yaw_rad += kPi;
    if (!clear_turn(check, before, pose)) clear_m = s - kBackReserveM;
    before = pose;
  }
  std::vector<Point2> out;
  for (size_t i = 0; i < back.size() && route.s_at(i) <= clear_m; ++i) out.push_back(back[i]);
  return out;
}

void PathPlanner::take_plan(const FullPlan& plan, const FullRequest& request, PlannerOutput& out) {
  // Also of a roomy plan: where less is left the next plan widens it, if that is possible, without a stop.
  active_.margin_m = request.squeeze_margin_m - config_.full.block_slack_m - sigma_margin_m();
  const double least_m = config_.full.least_corridor_m;
  active_.corridor_half_width_m =
      std::clamp(plan.clearance_m - kHalfCellM - kControlM, least_m, std::max(least_m, global_->corridor_half_width_m));
  std::vector<RoutePoint> points;
  legs_ = legs_of(plan.plan);
  if (plan.plan.backs_first)
    drive_ahead_first(plan, request);
  else
    points = way_to_plan(plan, request);
  legs_goal_reach_m_ = request.goal_reach_m;
  legs_end_m_ = plan.end_station_m;
  const bool turning = turning_;
  drive_leg(std::move(points), out);
  active_.cost = plan.cost;
  active_.cost_at_m = active_.progress_m;
  turning_ = turning && plan.held;
  judge();
}

// Before a plan begins astern: the way that is held, or to a halt.
void PathPlanner::drive_ahead_first(const FullPlan& plan, const FullRequest& request) {
  if (plan.held) {
    legs_.push_front({request.held->poses});
    return;
  }
  const double way_m = distance(position(rover()), position(request.stopped));
  if (way_m < kLeastHaltM) return;
  const double curvature = wrap_angle(request.stopped.yaw_rad - rover().yaw_rad) / way_m;
  CurveLeg leg;
  for (double way = 0.0; way < way_m; way += kPoseStepM) leg.poses.push_back(advanced(rover(), way, curvature));
  leg.poses.push_back(request.stopped);
  legs_.push_front(std::move(leg));
}

// What the rover drives before a new plan begins.
std::vector<RoutePoint> PathPlanner::way_to_plan(const FullPlan& plan, const FullRequest& request) const {
  std::vector<RoutePoint> points;
  const std::int8_t level = global_odom_.level_at(global_progress_m_);
  if (plan.held) {
    const double begin = std::max(0.0, active_.progress_m - kBehindM);
    const double end = request.held->end_m;
    const size_t first = active_.route.vertex_after(begin);
    for (size_t i = first > 0 ? first - 1 : 0; active_.route.s_at(i) < end - kPoseStepM; ++i)
      points.push_back({active_.route.points()[i].p, kNaN, level});
  } else {
    const double lead = distance(position(request.rover), position(request.start));
    for (double way = 0.0; way < lead - kPoseStepM; way += 2.0 * kPoseStepM)
      points.push_back({position(advanced(request.rover, way, request.start_curvature_per_m)), kNaN, level});
  }
  return points;
}

// The next one, after `points`; the last leads back to the global path.
void PathPlanner::drive_leg(std::vector<RoutePoint> points, PlannerOutput& out) {
  const CurveLeg leg = std::move(legs_.front());
  legs_.pop_front();
  append_poses(leg.poses, legs_.empty() ? legs_end_m_ : global_progress_m_, points);
  const bool at_goal = legs_.empty() && distance(points.back().p, global_odom_.points().back().p) <= legs_goal_reach_m_;
  if (legs_.empty() && !at_goal) append_way_back(legs_end_m_, points);
  adopt(Route(std::move(points)), leg.backwards ? PathKind::kRetreat : PathKind::kContinuous, out);
  turning_ = false;
}

// Once the rover is about to change its direction, or has.
bool PathPlanner::on_manoeuvre() const {
  return !legs_.empty() &&
         (active_.kind == PathKind::kRetreat || active_.route.length_m() - active_.progress_m < kManoeuvreM);
}

// Its legs are driven one after the other as they were planned, unless something comes in the way.
void PathPlanner::go_on_manoeuvre(PlannerOutput& out) {
  judge();
  if (strayed() || halted_before_block() || std::isfinite(block_.confirmed_m)) {
    give_up_manoeuvre();
    return;
  }
  if (!standing() || !at_retreat_end()) return;
  if (legs_blocked()) {
    give_up_manoeuvre();
    return;
  }
  drive_leg({}, out);
  judge();
}

bool PathPlanner::legs_blocked() const {
  const Terrain ground = terrain();
  const FootprintCheck check(ground, config_.footprint, active_.margin_m + sigma_margin_m(), 0.0, rover());
  return std::any_of(legs_.begin(), legs_.end(), [&](const CurveLeg& leg) {
    return std::any_of(leg.poses.begin(), leg.poses.end(), [&](const Pose2& pose) {
      return ground.contains(position(pose)) && !check.clear_of(pose, true);
    });
  });
}

// What is left of it leads nowhere: another path is wanted.
void PathPlanner::give_up_manoeuvre() {
  legs_.clear();
  replan_wanted_ = true;
}

// Beyond a plan the path leads back to the global one; before the rover comes there, there is another plan.
void PathPlanner::append_way_back(double station_m, std::vector<RoutePoint>& points) const {
  const double length = global_odom_.length_m();
  const Pose2 end{points.back().p.x_m, points.back().p.y_m,
                  std::atan2(points.back().p.y_m - points[points.size() - 2].p.y_m,
                             points.back().p.x_m - points[points.size() - 2].p.x_m)};
  const double off = distance(points.back().p, global_odom_.point_at(station_m));
  double join = station_m + 0.5 * kPoseStepM;
  if (off > kPoseStepM) {
    join = std::min(length, station_m + kBackAheadM + off);
    const Pose2 target = global_odom_.pose_at(join);
    const std::optional<DubinsPath> way = dubins_path(end, target, kBackRadiusM);
    const bool direct = way && way->length_m() < 1.5 * distance(position(end), position(target));
    if (direct) {
      std::vector<Pose2> poses = sample(end, {way->segments.begin(), way->segments.end()}, kPoseStepM);
      poses.erase(poses.begin());
      append_poses(poses, join, points);
    } else {
      points.push_back({position(target), kNaN, points.back().level});
    }
  }
  for (size_t i = global_odom_.vertex_after(join + 0.5 * config_.rounding.step_m); i < global_odom_.points().size();
       ++i)
    points.push_back(global_odom_.points()[i]);
}

}  // namespace rover::planning
