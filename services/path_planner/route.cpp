#include "path_planner/route.hpp"

namespace rover::planning {
namespace {

double heading(Point2 from, Point2 to) {
  return std::atan2(to.y_m - from.y_m, to.x_m - from.x_m);
}

Point2 between(Point2 a, Point2 b, double u) {
  return {a.x_m + u * (b.x_m - a.x_m), a.y_m + u * (b.y_m - a.y_m)};
}

struct Fillet {
  double tangent_m = 0.0;  // 0: the corner stays
  double radius_m = 0.0;
  double turn_rad = 0.0;
};

Fillet fillet_at(Point2 before, Point2 corner, Point2 after, const RoundingConfig& config) {
  const double turn = wrap_angle(heading(corner, after) - heading(before, corner));
  const double half = std::tan(0.5 * std::abs(turn));
  if (half < 1e-6) return {};
  const double room = 0.5 * std::min(distance(before, corner), distance(corner, after));
  const double by_deviation = config.tolerance_m / (1.0 / std::cos(0.5 * turn) - 1.0);
  const double radius = std::min({config.max_radius_m, room / half, by_deviation});
  if (radius < config.min_radius_m) return {};
  return {radius * half, radius, turn};
}

class Sampler {
 public:
  explicit Sampler(double step_m) : step_m_(step_m) {}

  void line_to(RoutePoint target) {
    const RoutePoint from = points_.back();
    const double length = distance(from.p, target.p);
    const int steps = static_cast<int>(std::ceil(length / step_m_ - 1e-6));
    for (int i = 1; i < steps; ++i) add(between(from.p, target.p, static_cast<double>(i) / steps), from.level);
    if (length > 1e-6) add(target.p, target.level);
  }

  void arc(double radius_m, double turn_rad, double heading_rad, std::int8_t level) {
    const Pose2 start{points_.back().p.x_m, points_.back().p.y_m, heading_rad};
    const double length = radius_m * std::abs(turn_rad);
    const int steps = std::max(1, static_cast<int>(std::ceil(length / step_m_)));
    for (int i = 1; i <= steps; ++i)
      add(position(advanced(start, length * i / steps, std::copysign(1.0 / radius_m, turn_rad))), level);
  }

  void add(Point2 p, std::int8_t level) {
    if (!points_.empty()) s_m_ += distance(points_.back().p, p);
    points_.push_back({p, s_m_, level});
  }

  std::vector<RoutePoint> take() { return std::move(points_); }

 private:
  double step_m_;
  double s_m_ = 0.0;
  std::vector<RoutePoint> points_;
};

}  // namespace

Route::Route(std::vector<RoutePoint> points) : points_(std::move(points)) {
  s_m_.reserve(points_.size());
  for (size_t i = 0; i < points_.size(); ++i)
    s_m_.push_back(i == 0 ? 0.0 : s_m_.back() + distance(points_[i - 1].p, points_[i].p));
  if (points_.size() >= 2) set_headings();
}

void Route::set_headings() {
  const size_t last = points_.size() - 1;
  std::vector<double> piece(last);
  for (size_t i = 0; i < last; ++i) {
    piece[i] = heading(points_[i].p, points_[i + 1].p) + (points_[i].reverse ? kPi : 0.0);
    if (i > 0) piece[i] = piece[i - 1] + wrap_angle(piece[i] - piece[i - 1]);
  }
  yaw_in_rad_.assign(last + 1, piece.front());
  yaw_out_rad_ = yaw_in_rad_;
  yaw_in_rad_[last] = yaw_out_rad_[last] = piece.back();
  for (size_t i = 1; i < last; ++i) {
    const bool corner = std::abs(piece[i] - piece[i - 1]) > kCornerRad;
    const double middle = 0.5 * (piece[i - 1] + piece[i]);
    yaw_in_rad_[i] = corner ? piece[i - 1] : middle;
    yaw_out_rad_[i] = corner ? piece[i] : middle;
    if (corner) corners_.push_back(i);
  }
  // The ends continue the bend of their neighbours.
  if (last >= 2) {
    yaw_out_rad_[0] = yaw_in_rad_[0] = 2.0 * piece[0] - yaw_in_rad_[1];
    yaw_in_rad_[last] = yaw_out_rad_[last] = 2.0 * piece[last - 1] - yaw_out_rad_[last - 1];
  }
}

size_t Route::vertex_after(double s_m) const {
  return static_cast<size_t>(std::upper_bound(s_m_.begin(), s_m_.end(), s_m) - s_m_.begin());
}

Point2 Route::point_at(double s_m) const {
  const size_t next = std::clamp<size_t>(vertex_after(s_m), 1, points_.size() - 1);
  const double span = s_m_[next] - s_m_[next - 1];
  const double u = span > 0.0 ? std::clamp((s_m - s_m_[next - 1]) / span, 0.0, 1.0) : 0.0;
  return between(points_[next - 1].p, points_[next].p, u);
}

Pose2 Route::pose_at(double s_m) const {
  const Point2 p = point_at(s_m);
  const size_t next = std::clamp<size_t>(vertex_after(s_m), 1, points_.size() - 1);
  const double span = s_m_[next] - s_m_[next - 1];
  const double u = span > 0.0 ? std::clamp((s_m - s_m_[next - 1]) / span, 0.0, 1.0) : 0.0;
  return {p.x_m, p.y_m, (1.0 - u) * yaw_out_rad_[next - 1] + u * yaw_in_rad_[next]};
}

std::int8_t Route::level_at(double s_m) const {
  return points_[std::clamp<size_t>(vertex_after(s_m), 1, points_.size()) - 1].level;
}

bool Route::reverse_at(double s_m) const {
  return points_[std::clamp<size_t>(vertex_after(s_m), 1, points_.size()) - 1].reverse;
}

bool Route::stops_at(size_t i) const {
  return points_[i - 1].reverse != points_[i].reverse || yaw_out_rad_[i] != yaw_in_rad_[i];
}

PathSegment Route::segment_at(double s_m) const {
  size_t begin = std::clamp<size_t>(vertex_after(s_m), 1, points_.size() - 1) - 1;
  size_t end = begin + 1;
  while (begin > 0 && !stops_at(begin)) --begin;
  while (end + 1 < points_.size() && !stops_at(end)) ++end;
  return {s_m_[begin], s_m_[end], points_[begin].reverse};
}

double Route::closest(Point2 p, double from_m, double to_m) const {
  const size_t first = std::clamp<size_t>(vertex_after(from_m), 1, points_.size() - 1);
  double best = kInfinity;
  double best_s = std::clamp(from_m, 0.0, length_m());
  for (size_t i = first; i < points_.size() && s_m_[i - 1] <= to_m; ++i) {
    const Point2 a = points_[i - 1].p;
    const Point2 b = points_[i].p;
    const double span = s_m_[i] - s_m_[i - 1];
    if (span <= 0.0) continue;
    const double along = ((p.x_m - a.x_m) * (b.x_m - a.x_m) + (p.y_m - a.y_m) * (b.y_m - a.y_m)) / span;
    const double s = std::clamp(s_m_[i - 1] + std::clamp(along, 0.0, span), from_m, std::max(from_m, to_m));
    const double d = distance(p, between(a, b, (s - s_m_[i - 1]) / span));
    if (d < best) {
      best = d;
      best_s = s;
    }
  }
  return best_s;
}

Route transformed(const Route& route, const Pose2& T) {
  std::vector<RoutePoint> points = route.points();
  const double c = std::cos(T.yaw_rad);
  const double s = std::sin(T.yaw_rad);
  for (RoutePoint& point : points)
    point.p = {T.x_m + c * point.p.x_m - s * point.p.y_m, T.y_m + s * point.p.x_m + c * point.p.y_m};
  return Route(std::move(points));
}

Route rounded(const std::vector<RoutePoint>& points, const RoundingConfig& config) {
  std::vector<RoutePoint> corners;  // each place once: a repeated one leaves no room to round
  for (const RoutePoint& point : points) {
    if (!corners.empty() && distance(corners.back().p, point.p) < 1e-6) corners.pop_back();
    corners.push_back(point);
  }
  Sampler sampler(config.step_m);
  sampler.add(corners.front().p, corners.front().level);
  for (size_t i = 1; i + 1 < corners.size(); ++i) {
    const Point2 before = corners[i - 1].p;
    const Point2 corner = corners[i].p;
    const Fillet fillet = fillet_at(before, corner, corners[i + 1].p, config);
    const double length = distance(before, corner);
    if (fillet.tangent_m <= 0.0 || length <= 0.0) {
      sampler.line_to(corners[i]);
      continue;
    }
    sampler.line_to({between(before, corner, 1.0 - fillet.tangent_m / length), kNaN, corners[i - 1].level});
    sampler.arc(fillet.radius_m, fillet.turn_rad, heading(before, corner), corners[i].level);
  }
  sampler.line_to(corners.back());
  return Route(sampler.take());
}

}  // namespace rover::planning
