#include "trajectory_control/tracked_path.hpp"

#include <algorithm>
#include <cmath>

namespace rover::control {
namespace {

using Points = std::vector<Eigen::Vector2d>;

constexpr double kDistinctM = 1e-3;
constexpr double kMaxLengthM = 1e5;
constexpr double kNearM = 0.5;           // the curve and the path run side by side
constexpr double kHeadingWeightM = 0.3;  // a radian of heading error counts as much as this distance
constexpr double kBesideShare = 0.5;     // of the half width: parts of the path that near all pass by the rover

Points distinct(const Points& points) {
  Points out;
  for (const auto& p : points)
    if (out.empty() || (p - out.back()).norm() > kDistinctM) out.push_back(p);
  return out;
}

bool finite(const Points& points) {
  return std::all_of(points.begin(), points.end(), [](const auto& p) { return p.allFinite(); });
}

double length(const Points& points) {
  double sum = 0.0;
  for (size_t i = 1; i < points.size(); ++i) sum += (points[i] - points[i - 1]).norm();
  return sum;
}

// Points at equal steps along the polyline, its ends included; `step_m` is shortened to fit.
Points resample(const Points& points, double& step_m) {
  const double total = length(points);
  const size_t count = static_cast<size_t>(std::max(1.0, std::ceil(total / step_m - 1e-9)));
  step_m = total / static_cast<double>(count);
  Points out;
  out.reserve(count + 1);
  size_t segment = 1;
  double passed = 0.0;
  for (size_t i = 0; i < count; ++i) {
    const double s = step_m * static_cast<double>(i);
    double segment_m = (points[segment] - points[segment - 1]).norm();
    while (s > passed + segment_m && segment + 1 < points.size()) {
      passed += segment_m;
      ++segment;
      segment_m = (points[segment] - points[segment - 1]).norm();
    }
    const double u = std::min((s - passed) / segment_m, 1.0);
    out.push_back((1.0 - u) * points[segment - 1] + u * points[segment]);
  }
  out.push_back(points.back());
  return out;
}

double yaw_of(const Eigen::Vector2d& direction) {
  return std::atan2(direction.y(), direction.x());
}

// Bend between the chords before and behind each sample. Near the ends, where there is no room for a whole chord, it is
// taken over shorter ones and counts in proportion: the shorter the chords, the more of it is noise.
std::vector<double> bends(const Points& samples, size_t chord) {
  std::vector<double> out(samples.size(), 0.0);
  for (size_t i = 1; i + 1 < samples.size(); ++i) {
    const size_t before = std::min(chord, i);
    const size_t behind = std::min(chord, samples.size() - 1 - i);
    const double turn = yaw_of(samples[i + behind] - samples[i]) - yaw_of(samples[i] - samples[i - before]);
    const double share = 2.0 * static_cast<double>(std::min(before, behind)) / static_cast<double>(chord);
    out[i] = std::min(share, 1.0) * std::abs(wrap_angle(turn));
  }
  return out;
}

// Samples at which legs end: the sharpest of each kink within a chord's length, and the last.
std::vector<size_t> leg_ends(const Points& samples, double step_m, const TrackedPathConfig& config) {
  const size_t chord = std::max<size_t>(1, static_cast<size_t>(std::lround(config.kink_chord_m / step_m)));
  const std::vector<double> bend = bends(samples, chord);
  std::vector<size_t> out;
  size_t i = 0;
  while (i < bend.size()) {
    if (bend[i] > config.kink_rad) {
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

// s_m: share of the segment passed. Before the first and past the last segment the line goes on.
Projection project_on_segment(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b, bool first,
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
  const bool goes_on = (first && outside < 0.0) || (last && outside > 0.0);
  out.beyond_m = goes_on ? outside : 0.0;
  out.cross_track_m = goes_on ? cross : std::copysign(out.distance_m, cross);
  return out;
}

// Samples at which the leg passes by the point: nearer than their neighbours.
std::vector<size_t> closest_passes(const std::vector<PathSample>& samples, const Eigen::Vector2d& p) {
  std::vector<size_t> out;
  const auto distance_m = [&](size_t i) { return (samples[i].p - p).norm(); };
  for (size_t i = 0; i < samples.size(); ++i) {
    const bool approached = i == 0 || distance_m(i) <= distance_m(i - 1);
    const bool left_behind = i + 1 == samples.size() || distance_m(i) < distance_m(i + 1);
    if (approached && left_behind) out.push_back(i);
  }
  return out;
}

}  // namespace

Leg::Leg(std::vector<Eigen::Vector2d> samples, double step_m, double start_m, const TrackedPathConfig& config)
    : step_m_(step_m), start_m_(start_m) {
  const Points curve = smooth(samples, step_m, config.smoother);
  samples_.resize(samples.size());
  for (size_t i = 0; i < samples.size(); ++i) {
    samples_[i].p = curve[i];
    samples_[i].given = samples[i];
  }
  set_headings();
  set_curvatures(config);
  set_speeds(config);
}

void Leg::set_headings() {
  const size_t last = samples_.size() - 1;
  for (size_t i = 0; i <= last; ++i) {
    const size_t from = i > 0 ? i - 1 : 0;
    const double yaw = yaw_of(samples_[std::min(i + 1, last)].p - samples_[from].p);
    samples_[i].yaw_rad = i == 0 ? yaw : samples_[i - 1].yaw_rad + wrap_angle(yaw - samples_[i - 1].yaw_rad);
  }
}

void Leg::set_curvatures(const TrackedPathConfig& config) {
  const size_t last = samples_.size() - 1;
  for (size_t i = 0; i <= last; ++i) {
    const size_t from = i > 1 ? i - 2 : 0;
    const size_t to = std::min(i + 2, last);
    const double turned = samples_[to].yaw_rad - samples_[from].yaw_rad;
    const double curvature = turned / (step_m_ * static_cast<double>(to - from));
    samples_[i].curvature_per_m = std::clamp(curvature, -config.max_curvature_per_m, config.max_curvature_per_m);
  }
}

void Leg::set_speeds(const TrackedPathConfig& config) {
  const size_t last = samples_.size() - 1;
  double behind_mps = 0.0;  // at rest at the end of the leg
  for (size_t n = 0; n <= last; ++n) {
    const size_t i = last - n;
    const double k = std::abs(samples_[i].curvature_per_m);
    const double outer = std::hypot(1.0 + k * config.outer_wheel_y_m, k * config.outer_wheel_x_m);
    const size_t from = i > 0 ? i - 1 : 0;
    const size_t to = std::min(i + 1, last);
    const double change = std::abs(samples_[to].curvature_per_m - samples_[from].curvature_per_m) /
                          (step_m_ * static_cast<double>(to - from));
    const double steering =
        change > 0.0 ? std::max(config.max_curvature_rate / change, config.least_speed_mps) : kInfinity;
    const double braking = n == 0 ? 0.0 : std::sqrt(behind_mps * behind_mps + 2.0 * config.deceleration_mps2 * step_m_);
    samples_[i].speed_mps = std::min({config.cruise_speed_mps, config.max_wheel_speed_mps / outer, steering, braking});
    behind_mps = samples_[i].speed_mps;
  }
}

PathSample Leg::at(double s_m) const {
  const double position = std::clamp(s_m / step_m_, 0.0, static_cast<double>(samples_.size() - 1));
  const size_t i = std::min(static_cast<size_t>(position), samples_.size() - 2);
  const double u = position - static_cast<double>(i);
  const PathSample& a = samples_[i];
  const PathSample& b = samples_[i + 1];
  PathSample out;
  out.p = (1.0 - u) * a.p + u * b.p;
  out.yaw_rad = (1.0 - u) * a.yaw_rad + u * b.yaw_rad;
  out.curvature_per_m = (1.0 - u) * a.curvature_per_m + u * b.curvature_per_m;
  // The square of a speed under constant deceleration is linear in the way.
  out.speed_mps = std::sqrt((1.0 - u) * a.speed_mps * a.speed_mps + u * b.speed_mps * b.speed_mps);
  return out;
}

template <class PointOf>
Projection Leg::project_on(const Eigen::Vector2d& p, double from_m, double to_m, PointOf point_of) const {
  const size_t segments = samples_.size() - 1;
  const double last = static_cast<double>(segments - 1);
  const size_t from = static_cast<size_t>(std::clamp(std::floor(from_m / step_m_), 0.0, last));
  const size_t to = static_cast<size_t>(std::clamp(std::floor(to_m / step_m_), 0.0, last));
  Projection best;
  best.distance_m = kInfinity;
  for (size_t i = from; i <= to; ++i) {
    const Eigen::Vector2d a = point_of(samples_[i]);
    const Projection candidate = project_on_segment(p, a, point_of(samples_[i + 1]), i == 0, i + 1 == segments);
    if (candidate.distance_m >= best.distance_m) continue;
    best = candidate;
    best.s_m = step_m_ * (static_cast<double>(i) + candidate.s_m);
  }
  return best;
}

Projection Leg::project(const Eigen::Vector2d& p, double from_m, double to_m) const {
  Projection out = project_on(p, from_m, to_m, [](const PathSample& sample) { return sample.p; });
  out.yaw_rad = at(out.s_m).yaw_rad;
  return out;
}

double Leg::cross_track_m(const Eigen::Vector2d& p, double near_m) const {
  return project_on(p, near_m - kNearM, near_m + kNearM, [](const PathSample& sample) { return sample.given; })
      .cross_track_m;
}

std::optional<TrackedPath> TrackedPath::build(const PathInput& input, const TrackedPathConfig& config) {
  if (!finite(input.points) || !(input.corridor_half_width_m > 0.0) || !std::isfinite(input.corridor_half_width_m))
    return std::nullopt;
  const Points points = distinct(input.points);
  if (points.size() < 2 || length(points) > kMaxLengthM) return std::nullopt;
  double step_m = config.sample_m;
  const Points samples = resample(points, step_m);
  TrackedPath path;
  path.id_ = input.id;
  path.corridor_half_width_m_ = input.corridor_half_width_m;
  size_t first = 0;
  for (const size_t end : leg_ends(samples, step_m, config)) {
    Points leg(samples.begin() + static_cast<long>(first), samples.begin() + static_cast<long>(end) + 1);
    path.legs_.emplace_back(std::move(leg), step_m, step_m * static_cast<double>(first), config);
    first = end;
  }
  return path;
}

Place TrackedPath::locate(const Pose2& pose) const {
  const Eigen::Vector2d p(pose.x_m, pose.y_m);
  double nearest_m = kInfinity;
  for (const Leg& leg : legs_)
    for (const PathSample& sample : leg.samples()) nearest_m = std::min(nearest_m, (sample.p - p).norm());
  const double beside_m = std::max(nearest_m, kBesideShare * corridor_half_width_m_);

  Place best;
  double least = kInfinity;
  for (size_t l = 0; l < legs_.size(); ++l) {
    const double step_m = legs_[l].length_m() / static_cast<double>(legs_[l].samples().size() - 1);
    for (const size_t i : closest_passes(legs_[l].samples(), p)) {
      const PathSample& sample = legs_[l].samples()[i];
      const double distance_m = (sample.p - p).norm();
      const double cost = std::hypot(distance_m, kHeadingWeightM * wrap_angle(sample.yaw_rad - pose.yaw_rad));
      if (distance_m > beside_m || cost >= least) continue;
      least = cost;
      best = {l, step_m * static_cast<double>(i)};
    }
  }
  return best;
}

}  // namespace rover::control
