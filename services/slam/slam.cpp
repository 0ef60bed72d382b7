#include "slam/slam.hpp"

#include <cmath>

namespace rover::slam {
namespace {

// SplitMix64: another seed for each cloud, so that a restored filter goes on with the same numbers.
std::uint64_t seed_of(std::uint64_t seed, Utime utime) {
  std::uint64_t z = seed + 0x9e3779b97f4a7c15ULL * static_cast<std::uint64_t>(utime);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

Pose2 only_informed(const Pose2& pose, const Pose2& reference, const Eigen::Matrix3d& informed) {
  const Eigen::Vector3d off(pose.x_m - reference.x_m, pose.y_m - reference.y_m,
                            wrap_angle(pose.yaw_rad - reference.yaw_rad));
  const Eigen::Vector3d kept = informed * off;
  return {reference.x_m + kept.x(), reference.y_m + kept.y(), reference.yaw_rad + kept.z()};
}

}  // namespace

Slam::Slam(const SlamConfig& config)
    : config_(config),
      map_(config.map),
      gatherer_(config.map.patches),
      matcher_(config.match),
      filter_(config.filter),
      anchor_(config.anchor) {}

bool Slam::take_pose(Utime utime, const Eigen::Isometry3d& T_map_odom, const Eigen::Isometry3d& T_odom_body) {
  const bool moved = anchor_.take(utime, T_map_odom, T_odom_body) && running();
  if (moved) anchor();
  return moved;
}

// From here on the error counts anew.
void Slam::anchor() {
  anchor_.anchor(T_slam_odom());
  anchor_way_m_ = way_m_;
}

bool Slam::has_jumped(const Odometry& odometry, const Odometry& from, Utime dt) const {
  const Eigen::Isometry3d moved = from.T_odom_body.inverse() * odometry.T_odom_body;
  const double s = to_seconds(dt), turned = log_so3(moved.linear()).norm();
  return moved.translation().norm() > config_.jump.top_speed_mps * s + config_.jump.slack_m ||
         turned > std::min(kPi, config_.jump.top_rate_radps * s + config_.jump.slack_rad);
}

// One odd pose is passed over; where the next cloud stays with it, odometry has begun anew, and so does the map.
std::string_view Slam::refusal_of(const Cloud& cloud, const Odometry& odometry) {
  if (cloud.points.empty()) return "empty";
  if (cloud.utime <= utime_) return "not newer than the one before";
  if (!is_finite(odometry.T_odom_body)) return "its pose is not finite";
  if (!running() || !has_jumped(odometry, last_, cloud.utime - utime_)) {
    suspect_.reset();
    return {};
  }
  if (suspect_ && cloud.utime > suspect_utime_ && !has_jumped(odometry, *suspect_, cloud.utime - suspect_utime_)) {
    start(odometry);
    return {};
  }
  suspect_ = odometry;
  suspect_utime_ = cloud.utime;
  return "odometry has jumped";
}

// While the level was lower. Against a map that begins anew the pose is not uncertain, however far the rover has come:
// particles spread by that way would drift within the spread.
bool Slam::has_left_map(const Odometry& odometry) const {
  const Eigen::Vector3d moved = odometry.T_odom_body.translation() - last_.T_odom_body.translation();
  return moved.head<2>().norm() > 0.5 * map_.grid().cells() * map_.grid().cell_m();
}

void Slam::start(const Odometry& odometry) {
  suspect_.reset();
  map_.clear();
  filter_.reset(planar(odometry.T_odom_body));
  last_ = odometry;
  z_m_ = odometry.T_odom_body.translation().z();
  lost_ = 0;
  anchor();
}

SlamResult Slam::step(const Cloud& cloud, const Odometry& odometry) {
  SlamResult result;
  result.refusal = refusal_of(cloud, odometry);
  if (!result.refusal.empty()) return result;
  Random random(seed_of(config_.seed, cloud.utime));
  if (!running() || has_left_map(odometry)) start(odometry);
  predict(odometry, cloud.utime, random);
  utime_ = cloud.utime;
  const LevelCloud levelled = level(cloud, odometry.T_odom_body, config_.attitude);
  const Weighed weighed = weigh(levelled, random);
  lost_ = weighed.status == Status::kLost ? lost_ + 1 : 0;
  if (lost_ >= config_.lost_clouds) map_.clear();
  if (lost_ == 0 || lost_ >= config_.lost_clouds) lay(levelled, weighed);
  result.status = weighed.status;
  result.T_slam_odom = T_slam_odom();
  result.T_map_odom = anchor_.T_map_odom(result.T_slam_odom);
  result.covariance = covariance();
  result.information = weighed.information;
  result.particles = static_cast<int>(filter_.particles().size());
  return result;
}

// An error that grows slowly is the gyro's bias, the same in each cloud: no noise.
double Slam::yaw_noise_rad(const Odometry& odometry, Utime dt) const {
  const double slow2 = config_.motion.slow_yaw_rad_rts * config_.motion.slow_yaw_rad_rts * to_seconds(dt);
  const double sigma2 = odometry.yaw_sigma_rad * odometry.yaw_sigma_rad;
  return std::sqrt(std::max(0.0, sigma2 - last_.yaw_sigma_rad * last_.yaw_sigma_rad - slow2));
}

void Slam::predict(const Odometry& odometry, Utime utime, Random& random) {
  const Pose2 motion = between(planar(last_.T_odom_body), planar(odometry.T_odom_body));
  const Eigen::Vector3d moved = odometry.T_odom_body.translation() - last_.T_odom_body.translation();
  const double way = moved.norm();
  const MotionConfig& m = config_.motion;
  // What grows slowly is an error of scale, the same in each cloud: no noise.
  const double grown = std::max(0.0, odometry.position_sigma_m - last_.position_sigma_m - m.scale_share * way);
  const double turn_grown = utime_ == kNever ? 0.0 : yaw_noise_rad(odometry, utime - utime_);
  const double blind = m.blind_share * std::max(0.0, odometry.blind_way_m - last_.blind_way_m);
  filter_.predict(motion,
                  {std::max({m.still_m, std::hypot(m.along_share * way, blind), grown}),
                   std::max({m.still_m, std::hypot(m.across_share * way, blind), grown}),
                   std::max(m.yaw_rad_per_m * way + m.yaw_share * std::abs(motion.yaw_rad), turn_grown)},
                  random);
  z_m_ += moved.z();
  way_m_ += way;
  last_ = odometry;
  const Pose2 mean = filter_.mean();
  map_.move_to(mean.x_m, mean.y_m);
}

Slam::Weighed Slam::weigh(const LevelCloud& cloud, Random& random) {
  Weighed weighed;
  const Pose2 predicted = filter_.mean();
  const MatchSurface surface(map_, z_m_, way_m_);
  matcher_.prepare(gatherer_.gather(cloud, Pose2{}), surface, predicted);
  if (!matcher_.enough()) return weighed;
  ParticleFilter trial = filter_;
  trial.weigh([&](const Pose2& pose) { return matcher_.fit(pose).log_likelihood; });
  const MatchInformation told = matcher_.information(trial.mean());
  if (told.directions == 3) filter_ = std::move(trial);
  // Along the others the particles weigh the same wherever they are.
  if (told.directions == 1 || told.directions == 2)
    filter_.weigh(
        [&](const Pose2& pose) { return matcher_.fit(only_informed(pose, predicted, told.informed)).log_likelihood; });
  weighed.status = told.directions > 0 ? Status::kOk : Status::kNoInformation;
  weighed.information = told.weakest;
  const MatchFit fit = matcher_.fit(filter_.mean(), 2);
  weighed.plane = fit.plane;
  if (fit.fitting_share < config_.min_fitting_share) weighed.status = Status::kLost;
  filter_.resample(random);
  return weighed;
}

void Slam::lay(LevelCloud cloud, const Weighed& weighed) {
  z_m_ -= static_cast<double>(weighed.plane.x());
  for (LevelPoint& p : cloud.points) p.z_m -= weighed.plane.y() * p.x_m + weighed.plane.z() * p.y_m;
  map_.insert(cloud, {filter_.mean(), z_m_, way_m_});
}

Pose2 Slam::T_slam_odom() const {
  return compose(filter_.mean(), between(planar(last_.T_odom_body), Pose2{}));
}

Eigen::Matrix3d Slam::covariance() const {
  const double way = way_m_ - anchor_way_m_;
  const double position = config_.drift.position_share * way;
  const double yaw2 = config_.drift.yaw_rad_per_sqrt_m * config_.drift.yaw_rad_per_sqrt_m * way;
  const Eigen::Matrix3d R = rotation_from_rpy(0.0, 0.0, anchor_.T_map_slam().yaw_rad);
  Eigen::Matrix3d cov = R * filter_.covariance() * R.transpose();
  cov.diagonal() += Eigen::Vector3d(position * position, position * position, yaw2);
  return cov;
}

// Cell by cell from the nearest of the own map: means of neighbours would lower what stands up.
OdomElevation Slam::elevation() const {
  OdomElevation out;
  const GridMap<ElevationCell>& grid = map_.grid();
  out.cell_m = grid.cell_m();
  out.cells = grid.cells();
  const Eigen::Vector3d rover = last_.T_odom_body.translation();
  const CellIndex center = grid.index_of(rover.x(), rover.y());
  out.corner = {center.ix - out.cells / 2, center.iy - out.cells / 2};
  const Pose2 T = T_slam_odom();
  const double c = std::cos(T.yaw_rad), s = std::sin(T.yaw_rad), up = height_offset_m();
  const size_t size = static_cast<size_t>(out.cells) * out.cells;
  out.height_m.reserve(size);
  out.sigma_m.reserve(size);
  for (int row = 0; row < out.cells; ++row)
    for (int column = 0; column < out.cells; ++column) {
      const double x = grid.center_x_m({out.corner.ix + column, 0}), y = grid.center_y_m({0, out.corner.iy + row});
      const ElevationCell& cell = grid.get(grid.index_of(T.x_m + c * x - s * y, T.y_m + s * x + c * y));
      const float nan = std::numeric_limits<float>::quiet_NaN();
      out.height_m.push_back(cell.seen() ? static_cast<float>(cell.top_m - up) : nan);
      out.sigma_m.push_back(cell.seen() ? std::sqrt(map_.variance_m2(cell, way_m_)) : nan);
    }
  return out;
}

}  // namespace rover::slam
