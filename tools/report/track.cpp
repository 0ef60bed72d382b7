#include "tools/report/track.hpp"

#include <algorithm>
#include <cmath>

#include "common/core/check.hpp"

namespace rover::report {
namespace {

constexpr double kStepM = 0.02;
constexpr double kMaxGapS = 0.1;

// As after a zone edit: the same corners ahead, the first point on the leg of the path where the rover is.
bool is_rest(const Points& part, const Points& whole) {
  constexpr double kRoundingM = 1e-6;
  if (part.size() < 2 || part.size() > whole.size()) return false;
  const Points tail(whole.end() - static_cast<std::ptrdiff_t>(part.size()), whole.end());
  return std::equal(part.begin() + 1, part.end(), tail.begin() + 1) &&
         distance_m({tail[0], tail[1]}, part.front()) < distance_m(whole, part.front()) + kRoundingM;
}

}  // namespace

Window drive_window(const RunRecord& run) {
  Window window;
  if (!run.truth.empty()) window = {run.truth.front().t_s, run.truth.back().t_s};
  const auto first = [&](State wanted) {
    return std::find_if(run.states.begin(), run.states.end(),
                        [wanted](const StateChange& change) { return change.state == wanted; });
  };
  if (const auto driving = first(State::kDriving); driving != run.states.end()) window.begin_s = driving->t_s;
  if (const auto goal = first(State::kGoalReached); goal != run.states.end()) window.end_s = goal->t_s;
  return window;
}

std::vector<PathRecord> followed_paths(const RunRecord& run, const Window& window) {
  std::vector<PathRecord> paths;
  const PathRecord* before = nullptr;
  for (const PathRecord& path : run.global_paths) {
    if (path.t_s > window.end_s) break;
    const bool rest = before != nullptr && is_rest(path.points, before->points);
    before = &path;
    if (rest) {
      paths.back().zones = path.zones;
      continue;
    }
    if (path.t_s <= window.begin_s) paths.clear();
    paths.push_back(path);
  }
  return paths;
}

TrueTrack::TrueTrack(const std::vector<TruthSample>& truth) : truth_(truth) {
  double distance = 0.0;
  Eigen::Vector3d counted = Eigen::Vector3d::Constant(kNaN);
  if (!truth.empty()) counted = truth.front().T_map_body.translation();
  for (const TruthSample& sample : truth_) {
    const Eigen::Vector3d p = sample.T_map_body.translation();
    double step = (p - counted).head<2>().norm();
    if (step >= kStepM) {
      distance += step;
      counted = p;
      step = 0.0;
    }
    distance_m_.push_back(distance + step);
  }
}

Eigen::Isometry3d TrueTrack::at(double t_s) const {
  ROVER_CHECK(!truth_.empty());
  const auto after = std::lower_bound(truth_.begin(), truth_.end(), t_s,
                                      [](const TruthSample& sample, double t) { return sample.t_s < t; });
  if (after == truth_.begin()) return truth_.front().T_map_body;
  if (after == truth_.end()) return truth_.back().T_map_body;
  const auto before = std::prev(after);
  return interpolate(before->T_map_body, after->T_map_body, (t_s - before->t_s) / (after->t_s - before->t_s));
}

std::optional<Eigen::Isometry3d> TrueTrack::known_at(double t_s) const {
  const auto after = std::lower_bound(truth_.begin(), truth_.end(), t_s,
                                      [](const TruthSample& sample, double t) { return sample.t_s < t; });
  if (after == truth_.end()) return std::nullopt;
  if (after->t_s == t_s) return after->T_map_body;
  if (after == truth_.begin() || after->t_s - std::prev(after)->t_s > kMaxGapS) return std::nullopt;
  return at(t_s);
}

Pose2 TrueTrack::planar_at(double t_s) const {
  return planar(at(t_s));
}

double TrueTrack::distance_m(double t_s) const {
  const TruthSample* sample = newest(truth_, t_s);
  return sample == nullptr ? 0.0 : distance_m_[static_cast<size_t>(sample - truth_.data())];
}

Pose2 compose(const Pose2& a, const Pose2& b) {
  const Eigen::Vector2d p = transform(a, {b.x_m, b.y_m});
  return {p.x(), p.y(), wrap_angle(a.yaw_rad + b.yaw_rad)};
}

Pose2 inverse(const Pose2& pose) {
  const double c = std::cos(pose.yaw_rad);
  const double s = std::sin(pose.yaw_rad);
  return {-c * pose.x_m - s * pose.y_m, s * pose.x_m - c * pose.y_m, -pose.yaw_rad};
}

Eigen::Vector2d transform(const Pose2& pose, const Eigen::Vector2d& p) {
  const double c = std::cos(pose.yaw_rad);
  const double s = std::sin(pose.yaw_rad);
  return {pose.x_m + c * p.x() - s * p.y(), pose.y_m + s * p.x() + c * p.y()};
}

Pose2 start_alignment(const RunRecord& run, const TrueTrack& truth, const Window& window) {
  const PoseSample* start = newest(run.poses, window.begin_s);
  if (start == nullptr && !run.poses.empty()) start = &run.poses.front();
  if (start == nullptr || truth.empty()) return {kNaN, kNaN, kNaN};
  return compose(truth.planar_at(start->t_s), inverse(planar(start->T_odom_body)));
}

std::vector<DriftSample> odometry_drift(const RunRecord& run, const TrueTrack& truth, const Window& window) {
  std::vector<DriftSample> drift;
  const Pose2 align = start_alignment(run, truth, window);
  const double begin_m = truth.distance_m(window.begin_s);
  for (const PoseSample& pose : run.poses) {
    if (!window.contains(pose.t_s) || truth.empty()) continue;
    const Pose2 estimate = compose(align, planar(pose.T_odom_body));
    const Eigen::Vector3d p = truth.at(pose.t_s).translation();
    drift.push_back({pose.t_s, truth.distance_m(pose.t_s) - begin_m, estimate.x_m - p.x(), estimate.y_m - p.y()});
  }
  return drift;
}

SlamTrack slam_track(const RunRecord& run, const TrueTrack& truth, const Window& window) {
  SlamTrack track;
  if (truth.empty()) return track;
  Pose2 align = start_alignment(run, truth, window);
  Eigen::Vector2d first_slam = Eigen::Vector2d::Zero(), first_odometry = Eigen::Vector2d::Zero();
  const double begin_m = truth.distance_m(window.begin_s);
  for (const SlamSample& sample : run.slam) {
    const PoseSample* pose = newest(run.poses, sample.t_s);
    if (pose == nullptr || !window.contains(sample.t_s)) continue;
    const Eigen::Vector2d p = truth.at(sample.t_s).translation().head<2>();
    const auto error = [&](const Pose2& T_slam_odom) -> Eigen::Vector2d {
      const Pose2 estimate = compose(compose(align, T_slam_odom), planar(pose->T_odom_body));
      return Eigen::Vector2d(estimate.x_m, estimate.y_m) - p;
    };
    const Eigen::Vector2d slam = error(sample.T_slam_odom), odometry = error({});
    if (track.drift.empty()) {
      first_slam = slam;
      first_odometry = odometry;
    }
    const double distance_m = truth.distance_m(sample.t_s) - begin_m;
    const auto since_first = [&](const Eigen::Vector2d& e, const Eigen::Vector2d& first) {
      return DriftSample{sample.t_s, distance_m, e.x() - first.x(), e.y() - first.y()};
    };
    track.drift.push_back(since_first(slam, first_slam));
    track.odometry.push_back(since_first(odometry, first_odometry));
  }
  align.x_m -= first_slam.x();
  align.y_m -= first_slam.y();
  for (const PoseSample& pose : run.poses) {
    const SlamSample* slam = newest(run.slam, pose.t_s);
    if (track.drift.empty() || slam == nullptr || pose.t_s < track.drift.front().t_s || pose.t_s > window.end_s)
      continue;
    const Eigen::Vector3d in_odom = pose.T_odom_body.translation();
    track.line.push_back(transform(align, transform(slam->T_slam_odom, {in_odom.x(), in_odom.y()})));
  }
  return track;
}

}  // namespace rover::report
