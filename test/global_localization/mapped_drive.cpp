#include "test/global_localization/mapped_drive.hpp"

#include <algorithm>
#include <cmath>

#include "common/core/frames.hpp"
#include "rover_simulator/world/noise.hpp"

namespace rover::global::test {
namespace {

constexpr double kStepM = 0.5;
constexpr double kCameraForwardM = 0.45, kCameraUpM = 1.10;  // over the ground
constexpr double kHalfWidthRad = to_rad(21.4), kPitchRad = to_rad(17.0), kHalfHeightRad = to_rad(16.3);
constexpr double kAzimuthStepRad = to_rad(0.3), kNearM = 1.2, kFarM = 12.0, kRangeStepM = 0.08;
constexpr int kCells = 200;
constexpr double kCellM = 0.1;

Eigen::Isometry2d planar_pose(const Eigen::Vector2d& p, double yaw_rad) {
  Eigen::Isometry2d T = Eigen::Isometry2d::Identity();
  T.translate(p).rotate(Eigen::Rotation2Dd(yaw_rad));
  return T;
}

double yaw_of(const Eigen::Isometry2d& T) {
  return Eigen::Rotation2Dd(T.linear()).angle();
}

}  // namespace

Eigen::Vector2d Line::at(double s_m) const {
  const Eigen::Vector2d straight(s_m, wave_m * std::sin(2.0 * kPi * s_m / wave_length_m));
  return start + Eigen::Rotation2Dd(heading_rad) * straight;
}

// Camera position of an image, and terrain slope under the rover.
struct MappedDrive::Viewpoint {
  Eigen::Vector2d camera;
  double camera_z, azimuth_rad, slope_forward, pitch_error_rad, roll_error_rad;
};

MappedDrive::MappedDrive(const Surface& world, const Line& line, const DriveErrors& errors, std::uint64_t seed,
                         const ElevationRaster* ground)
    : world_(world),
      ground_(ground),
      line_(line),
      errors_(errors),
      seed_(seed),
      random_(seed),
      map_(kCells, kCellM),
      known_(260, 0.5) {
  scale_ = 1.0 + normal(errors.scale_sigma);
  T_map_body_ = planar_pose(line.at(0.0), line.heading_rad);
  T_odom_body_ = planar_pose({3.0, -2.0}, 0.7);  // odom is turned against map
  for (int k = -4; k <= 4; ++k) look(to_rad(25.0) * k);
  publish();
}

// Box-Muller instead of std::normal_distribution, whose output depends on the library.
double MappedDrive::normal(double sigma) {
  const double u = (static_cast<double>(random_() >> 11) + 0.5) * 0x1p-53;
  const double v = (static_cast<double>(random_() >> 11) + 0.5) * 0x1p-53;
  return sigma * std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * kPi * v);
}

void MappedDrive::move(double step_m) {
  s_m_ += step_m;
  const Eigen::Vector2d p = line_.at(s_m_), ahead = line_.at(s_m_ + 0.1) - p;
  const Eigen::Isometry2d next = planar_pose(p, std::atan2(ahead.y(), ahead.x()));
  Eigen::Isometry2d motion = T_map_body_.inverse() * next;
  motion.translation() *= scale_;
  motion.rotate(Eigen::Rotation2Dd(normal(errors_.yaw_walk_rad_rtm * std::sqrt(step_m))));
  T_map_body_ = next;
  T_odom_body_ = T_odom_body_ * motion;
  height_drift_m_ += normal(errors_.height_walk_m_rtm * std::sqrt(step_m));
}

void MappedDrive::advance() {
  move(kStepM);
  const Eigen::Vector2d ahead = T_map_body_.inverse() * line_.at(s_m_ + 4.0);
  if (unit_of(random_()) >= errors_.lost_pictures) look(std::atan2(ahead.y(), ahead.x()));
  publish();
}

void MappedDrive::look(double pan_rad) {
  map_.move_to(T_odom_body_.translation().x(), T_odom_body_.translation().y());
  known_.move_to(T_map_body_.translation().x(), T_map_body_.translation().y());
  Viewpoint viewpoint;
  viewpoint.camera = T_map_body_ * Eigen::Vector2d(kCameraForwardM, 0.0);
  viewpoint.azimuth_rad = yaw_of(T_map_body_) + pan_rad;
  const Eigen::Vector2d way = Eigen::Rotation2Dd(viewpoint.azimuth_rad) * Eigen::Vector2d(0.75, 0.0);
  const Eigen::Vector2d p = T_map_body_.translation(), front = p + way, rear = p - way;
  viewpoint.slope_forward = (world_.height_m(front.x(), front.y()) - world_.height_m(rear.x(), rear.y())) / 1.5;
  viewpoint.camera_z = world_.height_m(p.x(), p.y()) + kCameraForwardM * viewpoint.slope_forward + kCameraUpM;
  viewpoint.pitch_error_rad = normal(errors_.attitude_sigma_rad);
  viewpoint.roll_error_rad = normal(errors_.attitude_sigma_rad);
  if (ground_ != nullptr) exposure_ = 1.0 + normal(errors_.exposure_sigma);
  for (double a = -kHalfWidthRad; a <= kHalfWidthRad; a += kAzimuthStepRad)
    look_along(viewpoint, viewpoint.azimuth_rad + a);
}

// Line-of-sight scan outwards: terrain below the horizon of nearer terrain is occluded.
void MappedDrive::look_along(const Viewpoint& viewpoint, double azimuth_rad) {
  const Eigen::Vector2d direction(std::cos(azimuth_rad), std::sin(azimuth_rad));
  double horizon = -kInfinity;
  for (double range = 0.3; range <= kFarM; range += kRangeStepM) {
    const Eigen::Vector2d p = viewpoint.camera + range * direction;
    const double z = world_.height_m(p.x(), p.y()), elevation = (z - viewpoint.camera_z) / range;
    if (elevation < horizon) continue;
    horizon = elevation;
    const double in_camera = std::atan(elevation) - std::atan(viewpoint.slope_forward) + kPitchRad;
    if (range >= kNearM && std::abs(in_camera) <= kHalfHeightRad) measure(viewpoint, {p.x(), p.y(), z});
  }
}

void MappedDrive::measure(const Viewpoint& viewpoint, const Eigen::Vector3d& p_map) {
  const double patch =
      0.5 + 0.5 * std::erf(gradient_noise(seed_ + 9, p_map.x() / 2.5, p_map.y() / 2.5) / std::sqrt(2.0));
  if (patch < errors_.untextured_fraction || unit_of(random_()) < errors_.lost_points) return;
  const Eigen::Vector3d camera(viewpoint.camera.x(), viewpoint.camera.y(), viewpoint.camera_z);
  Eigen::Vector3d ray = p_map - camera;
  const double d = ray.norm();
  const double sigma = errors_.depth_sigma_per_m2 * d * d;
  ray *= 1.0 + (normal(sigma) + errors_.depth_bias_per_m2 * d * d) / d;
  Eigen::Vector3d p = camera + ray;
  const Eigen::Vector2d flat = Eigen::Rotation2Dd(-viewpoint.azimuth_rad) * ray.head<2>();
  p.z() += flat.x() * viewpoint.pitch_error_rad + flat.y() * viewpoint.roll_error_rad + height_drift_m_;
  const Eigen::Vector2d in_odom = T_odom_body_ * (T_map_body_.inverse() * Eigen::Vector2d(p.x(), p.y()));
  const CellIndex cell = map_.index_of(in_odom.x(), in_odom.y());
  if (!map_.contains(cell)) return;
  const auto variance = static_cast<float>(1e-4 + 1e-6 * d * d * d * d);
  Ground& ground = map_.at(cell);
  const float brightness = brightness_at(p_map.head<2>());
  if (!ground.seen) ground = {static_cast<float>(p.z()), variance, brightness, true};
  const float gain = ground.variance / (ground.variance + variance);
  ground.brightness += gain * (brightness - ground.brightness);
  ground.z += gain * (static_cast<float>(p.z()) - ground.z);
  ground.variance = std::max((1.0f - gain) * ground.variance, 1e-5f);
  const CellIndex place = known_.index_of(p_map.x(), p_map.y());
  if (known_.contains(place)) known_.at(place) = 1;
}

float MappedDrive::brightness_at(const Eigen::Vector2d& p_map) {
  if (ground_ == nullptr) return 0.0f;
  const int column = std::clamp(static_cast<int>(p_map.x() / ground_->resolution_m), 0, ground_->width - 1);
  const int row = std::clamp(static_cast<int>(p_map.y() / ground_->resolution_m), 0, ground_->height - 1);
  return static_cast<float>(ground_->at(column, row) * exposure_ * (1.0 + normal(errors_.brightness_sigma)));
}

void MappedDrive::publish() {
  view_.lattice = {kCells, kCells, kCellM, map_.origin().ix * kCellM, map_.origin().iy * kCellM};
  view_.z_m.clear();
  view_.sigma_m.clear();
  view_.brightness.clear();
  map_.for_each([this](CellIndex, const Ground& ground) {
    view_.z_m.push_back(ground.seen ? ground.z : static_cast<float>(kNaN));
    view_.sigma_m.push_back(ground.seen ? std::sqrt(ground.variance) : static_cast<float>(kNaN));
    if (ground_ != nullptr) view_.brightness.push_back(ground.seen ? ground.brightness : static_cast<float>(kNaN));
  });
}

std::vector<Eigen::Vector2d> MappedDrive::seen_ground(double reach_m) const {
  std::vector<Eigen::Vector2d> out;
  const Eigen::Vector2d here = T_map_body_.translation();
  known_.for_each([&](CellIndex cell, std::uint8_t seen) {
    const Eigen::Vector2d p(known_.center_x_m(cell), known_.center_y_m(cell));
    if (seen != 0 && (p - here).cwiseAbs().maxCoeff() <= reach_m) out.push_back(p);
  });
  return out;
}

}  // namespace rover::global::test
