#include "path_planner/active_path.hpp"

#include "path_planner/search/footprint_check.hpp"

namespace rover::planning {
namespace {

constexpr double kSearchBackM = 0.5;
constexpr double kSearchAheadM = 1.0;
constexpr double kEndM = 0.1;
constexpr double kPastCornerM = 0.2;
constexpr double kChordM = 0.15;
constexpr double kMaxCurvature = 1.0;
constexpr double kSamePlaceM = 1e-6;
constexpr double kAtRestMps = 0.02;

bool same_place(const PlanPose& a, const PlanPose& b) {
  return distance(position(a.pose), position(b.pose)) < kSamePlaceM;
}

// A point of the route for every second pose, and for each where the rover turns or changes direction.
std::vector<RoutePoint> points_of(const std::vector<PlanPose>& plan, std::int8_t level) {
  std::vector<RoutePoint> points;
  bool skipped = true;
  for (size_t i = 0; i < plan.size(); ++i) {
    if (i > 0 && same_place(plan[i - 1], plan[i])) continue;
    size_t next = i + 1;
    while (next < plan.size() && same_place(plan[i], plan[next])) ++next;
    const bool turns = next > i + 1;
    const bool last = next == plan.size();
    const bool cusp = !last && plan[next].reverse != plan[i].reverse;
    skipped = !(skipped || turns || cusp || last);
    if (skipped) continue;
    points.push_back({position(plan[i].pose), kNaN, level, !last && plan[next].reverse});
  }
  return points;
}

}  // namespace

void ActivePath::set_route(std::int64_t id, PathKind kind, Route route, double corridor_half_width_m,
                           const Pose2& rover) {
  clear();
  id_ = id;
  kind_ = kind;
  route_ = std::move(route);
  corridor_half_width_m_ = corridor_half_width_m;
  planned_from_ = rover;
  progress_m_ = route_.closest(position(rover), 0.0, std::min(kSearchAheadM, route_.segment_at(0.0).end_m));
}

void ActivePath::set_plan(std::int64_t id, PathKind kind, std::vector<PlanPose> plan,
                          const std::vector<RoutePoint>& tail, double corridor_half_width_m, std::int8_t level,
                          const Pose2& rover) {
  std::vector<RoutePoint> points = points_of(plan, level);
  const size_t planned = points.size();
  points.insert(points.end(), tail.begin(), tail.end());
  if (points.size() < 2) points.push_back({position(advanced(plan.back().pose, 0.01, 0.0)), kNaN, level});
  set_route(id, kind, Route(std::move(points)), corridor_half_width_m, rover);
  plan_ = std::move(plan);
  plan_end_m_ = route_.s_at(planned - 1);
}

// The next segment begins where the rover no longer moves in the direction of this one, or has turned to the next.
void ActivePath::follow(const Pose2& rover, double forward_mps) {
  const PathSegment now = segment();
  progress_m_ = route_.closest(position(rover), std::max(progress_m_ - kSearchBackM, now.begin_m),
                               std::min(progress_m_ + kSearchAheadM, now.end_m));
  if (now.end_m - progress_m_ > kEndM || now.end_m >= route_.length_m()) return;
  const bool moves = (now.reverse ? -forward_mps : forward_mps) > kAtRestMps;
  const auto turn_to = [&](double yaw_rad) { return std::abs(wrap_angle(yaw_rad - rover.yaw_rad)); };
  const size_t next = route_.vertex_after(now.end_m) - 1;
  if (!moves || turn_to(route_.yaw_out_of(next)) < turn_to(route_.yaw_into(next))) progress_m_ = now.end_m;
}

// A path that passes one place twice may take the progress of the first for that of the second.
bool ActivePath::at_end(Point2 rover) const {
  if (segment().end_m < route_.length_m()) return false;
  return remaining_m() <= kEndM ||
         (remaining_m() <= kSearchAheadM && distance(route_.points().back().p, rover) <= kEndM);
}

ActivePath::Start ActivePath::start_after(double committed_m) const {
  PathSegment now = segment();
  double at = progress_m_ + committed_m;
  for (const size_t i : route_.corners())
    if (route_.s_at(i) > progress_m_ - kPastCornerM && route_.s_at(i) < at + kPastCornerM)
      at = std::max(at, route_.s_at(i) + kPastCornerM);
  while (now.end_m < at && now.end_m < route_.length_m() && route_.reverse_at(now.end_m) == now.reverse)
    now = route_.segment_at(now.end_m);
  at = std::min(at, now.end_m);
  const double chord = std::min(kChordM, at - now.begin_m);
  const double bend = chord > 0.0 ? (route_.pose_at(at).yaw_rad - route_.pose_at(at - chord).yaw_rad) / chord : 0.0;
  const double curvature = std::clamp(now.reverse ? -bend : bend, -kMaxCurvature, kMaxCurvature);
  return {route_.pose_at(at), curvature, now.reverse, at};
}

// Arc lengths of route and plan agree, as the plan is sampled finely.
std::vector<PlanPose> ActivePath::plan_from(double at_m, const ExpectedMotion& motion) const {
  std::vector<PlanPose> out;
  double s = 0.0;
  for (size_t i = 0; i < plan_.size(); ++i) {
    if (i > 0) s += distance(position(plan_[i - 1].pose), position(plan_[i].pose));
    if (s >= at_m) out.push_back({motion.shifted(plan_[i].pose, s), plan_[i].reverse, plan_[i].motion_cost});
  }
  return out;
}

std::vector<PlanPose> ActivePath::plan_until(double at_m, const ExpectedMotion& motion) const {
  constexpr double kBehindM = 0.3;
  std::vector<PlanPose> out;
  const PathSegment now = segment();
  for (double s = std::max(now.begin_m, progress_m_ - kBehindM); s < at_m; s += 0.5 * 0.1)
    out.push_back({motion.at(s), now.reverse, 0.0});
  return out;
}

std::vector<Pose2> ActivePath::views_until(double at_m) const {
  std::vector<Pose2> views;
  for (const size_t i : route_.corners()) {
    if (route_.s_at(i) <= progress_m_ - kPastCornerM || route_.s_at(i) > at_m) continue;
    const Point2 p = route_.points()[i].p;
    const double yaw_rad = route_.yaw_into(i);
    const double turn_rad = wrap_angle(route_.yaw_out_of(i) - yaw_rad);
    for (const Pose2& view : turn_views(yaw_rad, {p.x_m, p.y_m, yaw_rad + turn_rad})) views.push_back(view);
  }
  for (double s = progress_m_ + kViewStepM; s < at_m; s += kViewStepM) views.push_back(route_.pose_at(s));
  if (at_m > progress_m_) views.push_back(route_.pose_at(at_m));
  return views;
}

}  // namespace rover::planning
