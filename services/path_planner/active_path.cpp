#include "path_planner/active_path.hpp"

namespace rover::planning {
namespace {

constexpr double kSearchBackM = 0.5;
constexpr double kSearchAheadM = 1.0;
constexpr double kEndM = 0.1;
constexpr double kPastCornerM = 0.2;
constexpr double kChordM = 0.15;
constexpr double kMaxCurvature = 1.0;
constexpr double kSamePlaceM = 1e-6;
constexpr size_t kPosesPerPoint = 2;  // plans are verified every 5 cm and published every 10 cm

bool same_place(const PlanPose& a, const PlanPose& b) {
  return distance(position(a.pose), position(b.pose)) < kSamePlaceM;
}

}  // namespace

void ActivePath::set_route(std::int64_t id, PathKind kind, Route route, double corridor_half_width_m, Point2 rover) {
  clear();
  id_ = id;
  kind_ = forward_kind_ = kind;
  route_ = std::move(route);
  corridor_half_width_m_ = corridor_half_width_m;
  progress_m_ = route_.closest(rover, 0.0, kSearchAheadM);
}

void ActivePath::set_plan(std::int64_t id, PathKind forward_kind, std::vector<PlanPose> plan,
                          std::vector<RoutePoint> tail, double corridor_half_width_m, std::int8_t level, Point2 rover) {
  clear();
  forward_kind_ = forward_kind;
  plan_ = std::move(plan);
  tail_ = std::move(tail);
  corridor_half_width_m_ = corridor_half_width_m;
  level_ = level;
  publish_segment(id, rover);
}

void ActivePath::advance(std::int64_t id, Point2 rover) {
  publish_segment(id, rover);
}

void ActivePath::publish_segment(std::int64_t id, Point2 rover) {
  id_ = id;
  begin_ = next_ > 0 ? next_ - 1 : 0;  // the cusp belongs to both
  const bool reverse = plan_[std::min(begin_ + 1, plan_.size() - 1)].reverse;
  next_ = begin_ + 1;
  while (next_ < plan_.size() && plan_[next_].reverse == reverse) ++next_;
  kind_ = reverse ? PathKind::kBacktrack : forward_kind_;
  std::vector<RoutePoint> points;
  for (size_t i = begin_; i < next_; ++i) {
    const bool turned = i > begin_ && same_place(plan_[i - 1], plan_[i]);
    const bool turns = i + 1 < next_ && same_place(plan_[i], plan_[i + 1]);
    if (turned || ((i - begin_) % kPosesPerPoint != 0 && !turns && i + 1 != next_)) continue;
    points.push_back({position(plan_[i].pose), kNaN, level_});
  }
  const size_t planned = points.size();
  if (!has_next()) points.insert(points.end(), tail_.begin(), tail_.end());
  if (points.size() < 2) points.push_back({position(advanced(plan_.back().pose, 0.01, 0.0)), kNaN, level_});
  route_ = Route(std::move(points));
  plan_end_m_ = route_.s_at(planned - 1);
  progress_m_ = route_.closest(rover, 0.0, kSearchAheadM);
}

void ActivePath::follow(Point2 rover) {
  progress_m_ = route_.closest(rover, progress_m_ - kSearchBackM, progress_m_ + kSearchAheadM);
}

// A path that passes one place twice may take the progress of the first for that of the second.
bool ActivePath::at_end(Point2 rover) const {
  return remaining_m() <= kEndM ||
         (remaining_m() <= kSearchAheadM && distance(route_.points().back().p, rover) <= kEndM);
}

Pose2 ActivePath::pose_at(double s_m) const {
  Pose2 pose = route_.pose_at(s_m);
  if (reverse()) pose.yaw_rad += kPi;
  return pose;
}

ActivePath::Start ActivePath::start_after(double committed_m) const {
  double at = progress_m_ + committed_m;
  for (const size_t i : route_.corners())
    if (route_.s_at(i) > progress_m_ - kPastCornerM && route_.s_at(i) < at + kPastCornerM)
      at = std::max(at, route_.s_at(i) + kPastCornerM);
  at = std::min(at, has_next() ? plan_end_m_ : route_.length_m());
  const double chord = std::min(kChordM, at);
  const double bend = chord > 0.0 ? (route_.pose_at(at).yaw_rad - route_.pose_at(at - chord).yaw_rad) / chord : 0.0;
  const double curvature = std::clamp(reverse() ? -bend : bend, -kMaxCurvature, kMaxCurvature);
  return {pose_at(at), curvature, reverse(), at};
}

// Arc lengths of route and plan agree within a segment, as the plan is sampled finely.
std::vector<PlanPose> ActivePath::plan_from(double at_m) const {
  std::vector<PlanPose> out;
  double s = 0.0;
  for (size_t i = begin_; i < plan_.size(); ++i) {
    if (i > begin_) s += distance(position(plan_[i - 1].pose), position(plan_[i].pose));
    if (s >= at_m) out.push_back(plan_[i]);
  }
  return out;
}

std::vector<PlanPose> ActivePath::plan_until(double at_m) const {
  constexpr double kBehindM = 0.3;
  std::vector<PlanPose> out;
  const double from = std::max(0.0, progress_m_ - kBehindM);
  for (double s = from; s < at_m; s += 0.5 * 0.1) out.push_back({pose_at(s), reverse(), 0.0});
  return out;
}

}  // namespace rover::planning
