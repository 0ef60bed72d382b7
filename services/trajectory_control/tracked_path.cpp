#include "trajectory_control/tracked_path.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace rover::control {
namespace {

using Points = std::vector<Eigen::Vector2d>;

constexpr double kMinSpacingM = 1e-3;
constexpr double kMaxLengthM = 1e5;
constexpr double kSearchWindowM = 0.5;      // around the arc length of the smoothed curve
constexpr double kHeadingWeightM = 0.3;     // 1 rad of heading error costs as much as this distance
constexpr double kCandidateFraction = 0.5;  // of the half width: parts this close are candidates
constexpr double kBeginningM = 0.6;         // path_planner begins a path at most 0.5 m from the rover, which drives on

Points without_duplicates(const Points& points) {
  Points out;
  for (const auto& p : points)
    if (out.empty() || (p - out.back()).norm() > kMinSpacingM) out.push_back(p);
  return out;
}

bool all_finite(const Points& points) {
  return std::all_of(points.begin(), points.end(), [](const auto& p) { return p.allFinite(); });
}

double length(const Points& points) {
  double sum = 0.0;
  for (size_t i = 1; i < points.size(); ++i) sum += (points[i] - points[i - 1]).norm();
  return sum;
}

// Equally spaced points along the polyline, ends included; step_m is reduced to divide the length.
Points resample(const Points& points, double& step_m) {
  const double total_m = length(points);
  const size_t count = static_cast<size_t>(std::max(1.0, std::ceil(total_m / step_m - 1e-9)));
  step_m = total_m / static_cast<double>(count);
  Points out;
  out.reserve(count + 1);
  size_t edge = 1;
  double passed_m = 0.0;
  for (size_t i = 0; i < count; ++i) {
    const double s = step_m * static_cast<double>(i);
    double edge_m = (points[edge] - points[edge - 1]).norm();
    while (s > passed_m + edge_m && edge + 1 < points.size()) {
      passed_m += edge_m;
      ++edge;
      edge_m = (points[edge] - points[edge - 1]).norm();
    }
    const double u = std::min((s - passed_m) / edge_m, 1.0);
    out.push_back((1.0 - u) * points[edge - 1] + u * points[edge]);
  }
  out.push_back(points.back());
  return out;
}

double yaw_of(const Eigen::Vector2d& direction) {
  return std::atan2(direction.y(), direction.x());
}

// Angle between the chords before and after each sample. Near the ends chords are shorter and noisier, so the angle is
// scaled down in proportion.
std::vector<double> bend_angles(const Points& samples, size_t chord) {
  std::vector<double> out(samples.size(), 0.0);
  for (size_t i = 1; i + 1 < samples.size(); ++i) {
    const size_t before = std::min(chord, i);
    const size_t after = std::min(chord, samples.size() - 1 - i);
    const double turn_rad = yaw_of(samples[i + after] - samples[i]) - yaw_of(samples[i] - samples[i - before]);
    const double weight = 2.0 * static_cast<double>(std::min(before, after)) / static_cast<double>(chord);
    out[i] = std::min(weight, 1.0) * std::abs(wrap_angle(turn_rad));
  }
  return out;
}

// Indices at which segments end: the sharpest sample of each corner within one chord length, and the last sample.
std::vector<size_t> segment_ends(const Points& samples, double step_m, const TrackedPathConfig& config) {
  const size_t chord = std::max<size_t>(1, static_cast<size_t>(std::lround(config.corner_chord_m / step_m)));
  const std::vector<double> bend = bend_angles(samples, chord);
  std::vector<size_t> out;
  size_t i = 0;
  while (i < bend.size()) {
    if (bend[i] > config.corner_rad) {
      size_t sharpest = i;
      for (size_t k = i; k < std::min(i + chord, bend.size()); ++k)
        if (bend[k] > bend[sharpest]) sharpest = k;
      out.push_back(sharpest);
      i = sharpest + chord;
    }
    ++i;
  }
  out.push_back(samples.size() - 1);
  return out;
}

// Here s_m is the fraction of the edge (0..1). The first and last edges are extrapolated as lines.
Projection project_on_edge(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b, bool first,
                           bool last) {
  const double length_m = (b - a).norm();
  const Eigen::Vector2d along = (b - a) / length_m;
  const Eigen::Vector2d offset = p - a;
  const double t = offset.dot(along);
  const double cross = along.x() * offset.y() - along.y() * offset.x();
  const double outside = t - std::clamp(t, 0.0, length_m);
  Projection out;
  out.s_m = (t - outside) / length_m;
  out.distance_m = std::hypot(cross, outside);
  const bool extrapolated = (first && outside < 0.0) || (last && outside > 0.0);
  out.beyond_m = extrapolated ? outside : 0.0;
  out.cross_track_m = extrapolated ? cross : std::copysign(out.distance_m, cross);
  return out;
}

// Samples that are closer to the point than their neighbours.
std::vector<size_t> local_minima(const std::vector<PathSample>& samples, const Eigen::Vector2d& p) {
  std::vector<size_t> out;
  const auto distance_m = [&](size_t i) { return (samples[i].p - p).norm(); };
  for (size_t i = 0; i < samples.size(); ++i) {
    const bool not_farther_than_previous = i == 0 || distance_m(i) <= distance_m(i - 1);
    const bool closer_than_next = i + 1 == samples.size() || distance_m(i) < distance_m(i + 1);
    if (not_farther_than_previous && closer_than_next) out.push_back(i);
  }
  return out;
}

// Arc length up to which the rover can be. A path that begins at the rover may pass there again, but later; infinity:
// it begins farther off, and the rover may be anywhere on it.
double reached_m(std::span<const PathSegment> part, const Eigen::Vector2d& p) {
  if ((part[0].samples()[0].p - p).norm() > kBeginningM) return kInfinity;
  for (const PathSegment& segment : part)
    for (size_t i = 0; i < segment.samples().size(); ++i)
      if ((segment.samples()[i].p - p).norm() > kBeginningM) return segment.sample_m(i);
  return kInfinity;
}

}  // namespace

PathSegment::PathSegment(std::vector<Eigen::Vector2d> samples, double step_m, double start_m, bool reverse,
                         const TrackedPathConfig& config)
    : step_m_(step_m), start_m_(start_m), reverse_(reverse) {
  const Points curve = smooth(samples, step_m, config.smoother);
  samples_.resize(samples.size());
  for (size_t i = 0; i < samples.size(); ++i) {
    samples_[i].p = curve[i];
    samples_[i].p_path = samples[i];
  }
  set_headings();
  set_curvatures(config);
  set_speeds(config);
}

void PathSegment::set_headings() {
  const size_t last = samples_.size() - 1;
  for (size_t i = 0; i <= last; ++i) {
    const size_t from = i > 0 ? i - 1 : 0;
    const double yaw = yaw_of(samples_[std::min(i + 1, last)].p - samples_[from].p);
    samples_[i].yaw_rad = i == 0 ? yaw : samples_[i - 1].yaw_rad + wrap_angle(yaw - samples_[i - 1].yaw_rad);
  }
}

void PathSegment::set_curvatures(const TrackedPathConfig& config) {
  const size_t last = samples_.size() - 1;
  for (size_t i = 0; i <= last; ++i) {
    const size_t from = i > 1 ? i - 2 : 0;
    const size_t to = std::min(i + 2, last);
    const double yaw_change_rad = samples_[to].yaw_rad - samples_[from].yaw_rad;
    const double curvature = yaw_change_rad / (step_m_ * static_cast<double>(to - from));
    samples_[i].curvature_per_m = std::clamp(curvature, -config.max_curvature_per_m, config.max_curvature_per_m);
  }
}

void PathSegment::set_speeds(const TrackedPathConfig& config) {
  const size_t last = samples_.size() - 1;
  double next_mps = 0.0;  // backward pass: at rest at the end of the segment
  for (size_t n = 0; n <= last; ++n) {
    const size_t i = last - n;
    const double k = std::abs(samples_[i].curvature_per_m);
    const double outer_ratio = std::hypot(1.0 + k * config.outer_wheel_y_m, k * config.outer_wheel_x_m);
    const size_t from = i > 0 ? i - 1 : 0;
    const size_t to = std::min(i + 1, last);
    const double curvature_gradient = std::abs(samples_[to].curvature_per_m - samples_[from].curvature_per_m) /
                                      (step_m_ * static_cast<double>(to - from));
    const double steering_mps = curvature_gradient > 0.0
                                    ? std::max(config.max_curvature_rate / curvature_gradient, config.min_speed_mps)
                                    : kInfinity;
    const double braking_mps = n == 0 ? 0.0 : std::sqrt(next_mps * next_mps + 2.0 * config.deceleration_mps2 * step_m_);
    samples_[i].speed_mps =
        std::min({config.cruise_speed_mps, config.max_wheel_speed_mps / outer_ratio, steering_mps, braking_mps});
    next_mps = samples_[i].speed_mps;
  }
}

PathSample PathSegment::at(double s_m) const {
  const double position = std::clamp(s_m / step_m_, 0.0, static_cast<double>(samples_.size() - 1));
  const size_t i = std::min(static_cast<size_t>(position), samples_.size() - 2);
  const double u = position - static_cast<double>(i);
  const PathSample& a = samples_[i];
  const PathSample& b = samples_[i + 1];
  PathSample out;
  out.p = (1.0 - u) * a.p + u * b.p;
  out.yaw_rad = (1.0 - u) * a.yaw_rad + u * b.yaw_rad;
  out.curvature_per_m = (1.0 - u) * a.curvature_per_m + u * b.curvature_per_m;
  // Under constant deceleration the squared speed is linear in distance.
  out.speed_mps = std::sqrt((1.0 - u) * a.speed_mps * a.speed_mps + u * b.speed_mps * b.speed_mps);
  return out;
}

template <class PointOf>
Projection PathSegment::project_on(const Eigen::Vector2d& p, double from_m, double to_m, PointOf point_of) const {
  const size_t edges = samples_.size() - 1;
  const double last = static_cast<double>(edges - 1);
  const size_t from = static_cast<size_t>(std::clamp(std::floor(from_m / step_m_), 0.0, last));
  const size_t to = static_cast<size_t>(std::clamp(std::floor(to_m / step_m_), 0.0, last));
  Projection best;
  best.distance_m = kInfinity;
  for (size_t i = from; i <= to; ++i) {
    const Eigen::Vector2d a = point_of(samples_[i]);
    const Projection candidate = project_on_edge(p, a, point_of(samples_[i + 1]), i == 0, i + 1 == edges);
    if (candidate.distance_m >= best.distance_m) continue;
    best = candidate;
    best.s_m = step_m_ * (static_cast<double>(i) + candidate.s_m);
  }
  return best;
}

Projection PathSegment::project(const Eigen::Vector2d& p, double from_m, double to_m) const {
  Projection out = project_on(p, from_m, to_m, [](const PathSample& sample) { return sample.p; });
  out.yaw_rad = at(out.s_m).yaw_rad;
  return out;
}

double PathSegment::cross_track_m(const Eigen::Vector2d& p, double near_m) const {
  return project_on(p, near_m - kSearchWindowM, near_m + kSearchWindowM,
                    [](const PathSample& sample) { return sample.p_path; })
      .cross_track_m;
}

std::optional<TrackedPath> TrackedPath::build(const PathInput& input, const TrackedPathConfig& config) {
  if (!all_finite(input.points) || !(input.corridor_half_width_m > 0.0) || !std::isfinite(input.corridor_half_width_m))
    return std::nullopt;
  if (length(input.points) > kMaxLengthM) return std::nullopt;
  TrackedPath path;
  path.id_ = input.id;
  path.corridor_half_width_m_ = input.corridor_half_width_m;
  const auto reverse = [&](size_t i) { return i < input.reverse.size() && input.reverse[i]; };
  Points part;
  for (size_t i = 0; i < input.points.size(); ++i) {
    part.push_back(input.points[i]);
    const bool last = i + 1 == input.points.size();
    if (i == 0 || (!last && reverse(i) == reverse(i - 1))) continue;
    path.add_part(part, reverse(i - 1), config);
    part = {input.points[i]};  // a cusp belongs to both
  }
  if (path.segments_.empty()) return std::nullopt;
  return path;
}

void TrackedPath::add_part(const Points& part, bool reverse, const TrackedPathConfig& config) {
  const Points points = without_duplicates(part);
  if (points.size() < 2) return;
  const double start_m = segments_.empty() ? 0.0 : length_m();
  double step_m = config.sample_m;
  const Points samples = resample(points, step_m);
  size_t first = 0;
  for (const size_t end : segment_ends(samples, step_m, config)) {
    Points segment(samples.begin() + static_cast<long>(first), samples.begin() + static_cast<long>(end) + 1);
    segments_.emplace_back(std::move(segment), step_m, start_m + step_m * static_cast<double>(first), reverse, config);
    first = end;
  }
}

PathPosition TrackedPath::locate(const Pose2& pose) const {
  const Eigen::Vector2d p(pose.x_m, pose.y_m);
  const auto cusp = std::find_if(segments_.begin(), segments_.end(), [&](const PathSegment& segment) {
    return segment.reverse() != segments_[0].reverse();
  });
  const std::span<const PathSegment> part(segments_.begin(), cusp);
  const double end_m = reached_m(part, p);
  double nearest_m = kInfinity;
  for (const PathSegment& segment : part)
    for (size_t i = 0; i < segment.samples().size() && segment.sample_m(i) < end_m; ++i)
      nearest_m = std::min(nearest_m, (segment.samples()[i].p - p).norm());
  const double candidate_distance_m = std::max(nearest_m, kCandidateFraction * corridor_half_width_m_);

  PathPosition best;
  double min_cost = kInfinity;
  for (size_t l = 0; l < part.size(); ++l) {
    const double heading_rad = pose.yaw_rad + (part[l].reverse() ? kPi : 0.0);
    for (const size_t i : local_minima(part[l].samples(), p)) {
      const PathSample& sample = part[l].samples()[i];
      const double distance_m = (sample.p - p).norm();
      const double cost = std::hypot(distance_m, kHeadingWeightM * wrap_angle(sample.yaw_rad - heading_rad));
      if (part[l].sample_m(i) >= end_m || distance_m > candidate_distance_m || cost >= min_cost) continue;
      min_cost = cost;
      best = {l, part[l].step_m() * static_cast<double>(i)};
    }
  }
  return best;
}

}  // namespace rover::control
