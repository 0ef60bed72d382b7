#include "slam/slam.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace rover::slam {
namespace {

// SplitMix64, one seed per cloud: a restored filter continues with the same random numbers.
std::uint64_t cloud_seed(std::uint64_t seed, Utime utime) {
  std::uint64_t z = seed + 0x9e3779b97f4a7c15ULL * static_cast<std::uint64_t>(utime);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

Pose2 project_to_observable(const Pose2& pose, const Pose2& reference, const Eigen::Matrix3d& observable) {
  const Eigen::Vector3d offset(pose.x_m - reference.x_m, pose.y_m - reference.y_m,
                               wrap_angle(pose.yaw_rad - reference.yaw_rad));
  const Eigen::Vector3d projected = observable * offset;
  return {reference.x_m + projected.x(), reference.y_m + projected.y(), reference.yaw_rad + projected.z()};
}

}  // namespace

Slam::Slam(const SlamConfig& config)
    : config_(config),
      map_(config.map),
      binner_(config.map.patches),
      matcher_(config.match),
      match_error_(config.match_error),
      filter_(config.filter),
      anchor_(config.anchor) {}

bool Slam::add_pose(Utime utime, const Eigen::Isometry3d& T_map_odom, const Eigen::Isometry3d& T_odom_body) {
  const bool moved = anchor_.add_pose(utime, T_map_odom, T_odom_body) && running();
  if (moved) anchor();
  return moved;
}

// The covariance counts from the newest anchor.
void Slam::anchor() {
  anchor_.anchor(T_slam_odom());
  anchor_travelled_m_ = travelled_m_;
}

bool Slam::has_jumped(const Odometry& odometry, const Odometry& from, Utime dt) const {
  const Eigen::Isometry3d moved = from.T_odom_body.inverse() * odometry.T_odom_body;
  const double s = to_seconds(dt), turned = log_so3(moved.linear()).norm();
  return moved.translation().norm() > config_.jump.max_speed_mps * s + config_.jump.tolerance_m ||
         turned > std::min(kPi, config_.jump.max_rate_radps * s + config_.jump.tolerance_rad);
}

// A single jump is ignored. If the next cloud confirms it, odometry was restarted, and the map restarts too.
std::string_view Slam::rejection_of(const Cloud& cloud, const Odometry& odometry) {
  if (cloud.points.empty()) return "empty";
  if (cloud.utime <= utime_) return "not newer than the one before";
  if (!is_finite(odometry.T_odom_body)) return "its pose is not finite";
  if (!running() || !has_jumped(odometry, previous_, cloud.utime - utime_)) {
    jump_candidate_.reset();
    return {};
  }
  if (jump_candidate_ && cloud.utime > jump_utime_ &&
      !has_jumped(odometry, *jump_candidate_, cloud.utime - jump_utime_)) {
    start(odometry);
    return {};
  }
  jump_candidate_ = odometry;
  jump_utime_ = cloud.utime;
  return "odometry has jumped";
}

// Happens after driving at the Efficient level. The particles must not spread by the distance driven since: relative
// to a new map the pose is certain.
bool Slam::has_left_map(const Odometry& odometry) const {
  const Eigen::Vector3d moved = odometry.T_odom_body.translation() - previous_.T_odom_body.translation();
  return moved.head<2>().norm() > 0.5 * map_.grid().cells() * map_.grid().cell_m();
}

// A localization that lost its checkpoint. One with it may have lost the last second.
bool Slam::is_of_new_odom(const Odometry& odometry) const {
  constexpr double kMaxLostM = 0.5;
  return odometry.travelled_m < previous_.travelled_m - kMaxLostM;
}

void Slam::start(const Odometry& odometry) {
  jump_candidate_.reset();
  map_.clear();
  filter_.reset(planar(odometry.T_odom_body));
  previous_ = odometry;
  z_m_ = odometry.T_odom_body.translation().z();
  lost_count_ = 0;
  anchor();
}

SlamResult Slam::step(const Cloud& cloud, const Odometry& odometry) {
  SlamResult result;
  result.rejection = rejection_of(cloud, odometry);
  if (!result.rejection.empty()) return result;
  Random random(cloud_seed(config_.seed, cloud.utime));
  if (!running() || is_of_new_odom(odometry) || has_left_map(odometry)) start(odometry);
  gap_unmeasured_ = gap_unmeasured_ || odometry.dead_reckoned_m > previous_.dead_reckoned_m;
  predict(odometry, cloud.utime, random);
  utime_ = cloud.utime;
  const AlignedCloud aligned = align_to_gravity(cloud, odometry.T_odom_body, config_.attitude);
  MatchOutcome match = match_cloud(aligned, random);
  lost_count_ = match.status == Status::kLost ? lost_count_ + 1 : 0;
  if (lost_count_ >= config_.lost_clouds) {
    map_.clear();
    match.plane.setZero();  // relative to the map that is gone
  }
  result.inserted = lost_count_ == 0 || lost_count_ >= config_.lost_clouds;
  if (result.inserted) insert_cloud(aligned, match);
  result.status = match.status;
  result.T_slam_odom = T_slam_odom();
  result.T_map_odom = anchor_.T_map_odom(result.T_slam_odom);
  result.covariance = covariance();
  gap_unmeasured_ = gap_unmeasured_ && !match.position_observable;
  result.information = gap_unmeasured_ ? 0.0 : match.information;
  result.particles = static_cast<int>(filter_.particles().size());
  return result;
}

// Slow growth is gyro bias, constant from cloud to cloud: not noise.
double Slam::yaw_noise_rad(const Odometry& odometry, Utime dt) const {
  const double slow2 =
      config_.motion.gyro_bias_rad_per_sqrt_s * config_.motion.gyro_bias_rad_per_sqrt_s * to_seconds(dt);
  const double sigma2 = odometry.yaw_sigma_rad * odometry.yaw_sigma_rad;
  return std::sqrt(std::max(0.0, sigma2 - previous_.yaw_sigma_rad * previous_.yaw_sigma_rad - slow2));
}

void Slam::predict(const Odometry& odometry, Utime utime, Random& random) {
  const Pose2 motion = between(planar(previous_.T_odom_body), planar(odometry.T_odom_body));
  const Eigen::Vector3d moved = odometry.T_odom_body.translation() - previous_.T_odom_body.translation();
  const double distance_m = moved.norm();
  const MotionConfig& m = config_.motion;
  // Slow growth is scale error, constant from cloud to cloud: not noise.
  const double position_growth =
      std::max(0.0, odometry.position_sigma_m - previous_.position_sigma_m - m.scale_error_per_m * distance_m);
  growth_per_m_ =
      std::max(0.0, odometry.position_sigma_m - previous_.position_sigma_m) / std::max(distance_m, m.min_noise_m);
  const double yaw_growth = utime_ == kNever ? 0.0 : yaw_noise_rad(odometry, utime - utime_);
  const double dead_reckoned =
      m.dead_reckoned_sigma_per_m * std::max(0.0, odometry.dead_reckoned_m - previous_.dead_reckoned_m);
  filter_.predict(
      motion,
      {std::max({m.min_noise_m, std::hypot(m.along_sigma_per_m * distance_m, dead_reckoned), position_growth}),
       std::max({m.min_noise_m, std::hypot(m.across_sigma_per_m * distance_m, dead_reckoned), position_growth}),
       std::max(m.yaw_rad_per_m * distance_m + m.yaw_sigma_ratio * std::abs(motion.yaw_rad), yaw_growth)},
      random);
  z_m_ += moved.z();
  travelled_m_ += distance_m;
  match_error_.predict(distance_m);
  if (odometry.dead_reckoned_m > previous_.dead_reckoned_m) gap_at_m_ = travelled_m_;
  previous_ = odometry;
  const Pose2 mean = filter_.mean();
  map_.move_to(mean.x_m, mean.y_m);
}

Slam::MatchOutcome Slam::match_cloud(const AlignedCloud& cloud, Random& random) {
  MatchOutcome match;
  const Pose2 predicted = filter_.mean();
  const MatchSurface surface(map_, z_m_, travelled_m_);
  matcher_.prepare(binner_.bin_cloud(cloud, Pose2{}), surface, predicted);
  if (!matcher_.has_enough_points()) return match;
  const Pose2 bias = match_error_.bias();
  const auto log_likelihood = [&](const Pose2& pose) {
    return matcher_.fit(compose(pose, bias)).log_likelihood / match_error_.scatter();
  };
  ParticleFilter trial = filter_;
  trial.update(log_likelihood);
  const Pose2 matched = compose(trial.mean(), bias);
  const MatchInformation info = matcher_.information(matched);
  const MatchFit best = matcher_.fit(matched, 2);
  match.plane = best.plane;
  if (best.inlier_ratio < config_.min_inlier_ratio) {
    match.status = Status::kLost;
    return match;
  }
  // Only if visual odometry had no gap since the matched part of the map was seen.
  if (travelled_m_ - gap_at_m_ > config_.match.max_range_m) learn_match_error(matched, info);
  if (info.observable_directions == 3) filter_ = std::move(trial);
  // Unobservable directions must not change the weights.
  if (info.observable_directions == 1 || info.observable_directions == 2)
    filter_.update(
        [&](const Pose2& pose) { return log_likelihood(project_to_observable(pose, predicted, info.observable)); });
  match.status = info.observable_directions > 0 ? Status::kOk : Status::kNoInformation;
  match.information = info.weakest_information;
  match.position_observable = position_observable(info);
  match.plane = matcher_.fit(compose(filter_.mean(), bias), 2).plane;
  filter_.resample(random);
  return match;
}

bool Slam::position_observable(const MatchInformation& info) const {
  const Eigen::Matrix2d information = info.matrix.topLeftCorner<2, 2>();
  const double weakest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(information).eigenvalues()(0);
  return weakest * config_.match.unobservable_sigma_m * config_.match.unobservable_sigma_m > 1.0;
}

// Before the particles take the match: their mean is the predicted pose.
void Slam::learn_match_error(const Pose2& matched, const MatchInformation& info) {
  const Pose2 predicted = filter_.mean();
  const Pose2 fit = between(predicted, {matched.x_m + info.to_best.x(), matched.y_m + info.to_best.y(), 0.0});
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(predicted.yaw_rad).toRotationMatrix();
  if (!position_observable(info)) return;
  const Eigen::Matrix2d covariance = info.matrix.topLeftCorner<2, 2>().inverse();
  // Odometry also drifted since the matched part of the map was seen.
  const double pose_sigma_m = std::hypot(std::sqrt(0.5 * filter_.covariance().topLeftCorner<2, 2>().trace()),
                                         growth_per_m_ * config_.match.max_range_m);
  match_error_.update({fit.x_m, fit.y_m}, R.transpose() * covariance * R, pose_sigma_m);
}

void Slam::insert_cloud(AlignedCloud cloud, const MatchOutcome& match) {
  z_m_ -= static_cast<double>(match.plane.x());
  for (AlignedPoint& p : cloud.points) p.z_m -= match.plane.y() * p.x_m + match.plane.z() * p.y_m;
  map_.insert(cloud, {filter_.mean(), z_m_, travelled_m_});
}

Pose2 Slam::T_slam_odom() const {
  return compose(filter_.mean(), between(planar(previous_.T_odom_body), Pose2{}));
}

Eigen::Matrix3d Slam::covariance() const {
  const double distance_m = travelled_m_ - anchor_travelled_m_;
  const double position = config_.drift.position_sigma_per_m * distance_m;
  const double yaw2 = config_.drift.yaw_rad_per_sqrt_m * config_.drift.yaw_rad_per_sqrt_m * distance_m;
  const Eigen::Matrix3d R = rotation_from_rpy(0.0, 0.0, anchor_.T_map_slam().yaw_rad);
  Eigen::Matrix3d cov = R * filter_.covariance() * R.transpose();
  cov.diagonal() += Eigen::Vector3d(position * position, position * position, yaw2);
  return cov;
}

// Nearest-neighbour resampling: interpolation would lower rocks.
OdomElevation Slam::elevation() const {
  OdomElevation out;
  const GridMap<ElevationCell>& grid = map_.grid();
  out.cell_m = grid.cell_m();
  out.cells = grid.cells();
  const Eigen::Vector3d rover = previous_.T_odom_body.translation();
  const CellIndex center = grid.index_of(rover.x(), rover.y());
  out.corner = {center.ix - out.cells / 2, center.iy - out.cells / 2};
  const Pose2 T = T_slam_odom();
  const double c = std::cos(T.yaw_rad), s = std::sin(T.yaw_rad), height_offset = height_offset_m();
  const size_t size = static_cast<size_t>(out.cells) * out.cells;
  out.height_m.reserve(size);
  out.sigma_m.reserve(size);
  out.brightness.reserve(size);
  for (int row = 0; row < out.cells; ++row)
    for (int column = 0; column < out.cells; ++column) {
      const double x = grid.center_x_m({out.corner.ix + column, 0}), y = grid.center_y_m({0, out.corner.iy + row});
      const ElevationCell& cell = grid.get(grid.index_of(T.x_m + c * x - s * y, T.y_m + s * x + c * y));
      const float nan = std::numeric_limits<float>::quiet_NaN();
      out.height_m.push_back(cell.seen() ? static_cast<float>(cell.top_m - height_offset) : nan);
      out.sigma_m.push_back(cell.seen() ? std::sqrt(map_.variance_m2(cell, travelled_m_)) : nan);
      out.brightness.push_back(cell.brightness);
    }
  if (std::all_of(out.brightness.begin(), out.brightness.end(), [](float b) { return std::isnan(b); }))
    out.brightness.clear();
  return out;
}

}  // namespace rover::slam
