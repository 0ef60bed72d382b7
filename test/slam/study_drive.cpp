#include "test/slam/study_drive.hpp"

#include <algorithm>

#include "common/geo/elevation_map.hpp"
#include "rover_simulator/world/world.hpp"

namespace rover::slam::study {
namespace {

using namespace testing_support;

constexpr double kRasterM = 0.04;
constexpr double kVisibleM = 14.0;
constexpr double kFrameM = 0.08;  // between two frames of visual odometry at 0.2 m/s

// Cached heights around the drive: they are sampled about 1e9 times.
class HeightRaster {
 public:
  HeightRaster(const World& world, Eigen::Vector2d low, Eigen::Vector2d high) : low_(low) {
    columns_ = static_cast<int>((high.x() - low.x()) / kRasterM) + 2;
    rows_ = static_cast<int>((high.y() - low.y()) / kRasterM) + 2;
    for (int row = 0; row < rows_; ++row)
      for (int column = 0; column < columns_; ++column)
        z_.push_back(static_cast<float>(world.height_m(low.x() + column * kRasterM, low.y() + row * kRasterM)));
  }
  double operator()(double x, double y) const {
    const double u = std::clamp((x - low_.x()) / kRasterM, 0.0, columns_ - 1.001);
    const double v = std::clamp((y - low_.y()) / kRasterM, 0.0, rows_ - 1.001);
    const int i = static_cast<int>(u), j = static_cast<int>(v);
    const double a = u - i, b = v - j;
    const float* at = z_.data() + static_cast<size_t>(j) * columns_ + i;
    return (1 - b) * ((1 - a) * at[0] + a * at[1]) + b * ((1 - a) * at[columns_] + a * at[columns_ + 1]);
  }

 private:
  Eigen::Vector2d low_;
  int columns_ = 0, rows_ = 0;
  std::vector<float> z_;
};

// Pose on the ground without rocks: plane through the wheel contact points.
Eigen::Isometry3d pose_on_ground(const World& world, const Pose2& pose) {
  const double c = std::cos(pose.yaw_rad), s = std::sin(pose.yaw_rad);
  double mean = 0.0, pitch = 0.0, roll = 0.0;
  for (const double x : {-0.75, 0.0, 0.75})
    for (const double y : {-0.41, 0.41}) {
      const double z = world.ground_height_m(pose.x_m + c * x - s * y, pose.y_m + s * x + c * y);
      mean += z / 6.0;
      pitch -= z * x / (4.0 * 0.75 * 0.75);
      roll += z * y / (6.0 * 0.41 * 0.41);
    }
  return make_pose(rotation_from_rpy(std::atan(roll), std::atan(pitch), pose.yaw_rad),
                   {pose.x_m, pose.y_m, mean + kOriginHeightM});
}

// Winding track near the DTM's centre.
std::vector<Pose2> track_of(const DriveConfig& config, const World& world, Random& random) {
  const double heading = 2.0 * kPi * random.unit(), wave = 18.0 + 10.0 * random.unit(), swing = to_rad(35.0);
  std::vector<Pose2> track;
  Pose2 pose{0.0, 0.0, heading};
  for (double s = 0.0; s <= config.length_m + 1e-9; s += config.step_m) {
    pose.yaw_rad = heading + swing * std::sin(2.0 * kPi * s / wave);
    track.push_back(pose);
    const double middle = heading + swing * std::sin(2.0 * kPi * (s + 0.5 * config.step_m) / wave);
    pose.x_m += config.step_m * std::cos(middle);
    pose.y_m += config.step_m * std::sin(middle);
  }
  const double x = 0.5 * world.width_m() + 60.0 * (random.unit() - 0.5),
               y = 0.5 * world.length_m() + 60.0 * (random.unit() - 0.5);
  const Pose2 middle = track[track.size() / 2];
  for (Pose2& p : track) p.x_m += x - middle.x_m, p.y_m += y - middle.y_m;
  return track;
}

}  // namespace

std::vector<Station> simulated_drive(const DriveConfig& config, const std::string& dtm_file) {
  WorldConfig world_config;
  world_config.rocks.k = config.flat ? 0.0 : config.rock_k;
  if (config.flat) world_config.roughness.rms_m = 0.0;
  const ElevationRaster dtm = config.flat ? plane_raster(348, 337, 1.0, 0.0, 0.0) : read_elevation_map(dtm_file).raster;
  const World world(world_config, dtm, config.seed);
  Random random(config.seed);
  const std::vector<Pose2> track = track_of(config, world, random);
  Eigen::Vector2d low(kInfinity, kInfinity), high = -low;
  for (const Pose2& p : track) {
    low = low.cwiseMin(Eigen::Vector2d(p.x_m - kVisibleM, p.y_m - kVisibleM));
    high = high.cwiseMax(Eigen::Vector2d(p.x_m + kVisibleM, p.y_m + kVisibleM));
  }
  const HeightRaster heights(world, low, high);
  NavcamModel camera;
  camera.disparity_offset_px = config.disparity_offset_px;
  std::vector<Station> drive;
  for (const Pose2& pose : track) {
    const Eigen::Isometry3d T = pose_on_ground(world, pose);
    drive.push_back({T, cloud_of(heights, T, camera, random, to_utime(2.5 * static_cast<double>(drive.size() + 1)))});
  }
  return drive;
}

OdometryModel nominal_odometry() {
  return {};
}

OdometryModel degraded_odometry() {
  OdometryModel model;
  model.scale_sigma = 0.006;
  model.step_sigma_ratio = 0.03;
  model.yaw_rad_per_sqrt_m = to_rad(0.01);
  model.lost_fraction = 0.2;
  return model;
}

OdometryTrack simulated_odometry(const std::vector<Station>& drive, const OdometryModel& model, std::uint64_t seed) {
  Random random(seed * 7919 + 17);
  const double scale = 1.0 + model.scale_sigma * random.gauss();
  Eigen::Isometry3d T = from_planar({0.0, 0.0, 0.0});
  T.linear() =
      rotation_from_rpy(rpy_of(drive[0].T_map_body.linear()).x(), rpy_of(drive[0].T_map_body.linear()).y(), 0.0);
  const double first_yaw = yaw_of(drive[0].T_map_body);
  double yaw_error = 0.0, variance = 0.0, travelled_m = 0.0, dead_reckoned_m = 0.0;
  Eigen::Vector2d tilt = Eigen::Vector2d::Zero();
  OdometryTrack track;
  for (size_t i = 0; i < drive.size(); ++i) {
    if (i > 0) {
      const Eigen::Isometry3d motion = drive[i - 1].T_map_body.inverse() * drive[i].T_map_body;
      const double length = motion.translation().norm();
      const int frames = std::max(1, static_cast<int>(std::lround(length / kFrameM)));
      Eigen::Vector3d moved = Eigen::Vector3d::Zero();
      for (int k = 0; k < frames; ++k) {
        const bool lost = random.unit() < model.lost_fraction;
        const double slip = lost ? model.slip_mean + model.slip_sigma * random.gauss() : 0.0;
        const double share = model.step_sigma_ratio * random.gauss();
        const double aside = model.step_sigma_ratio * random.gauss();
        const Eigen::Vector3d part = motion.translation() / frames;
        moved += part * (scale + share + slip) + part.norm() * aside * Eigen::Vector3d::UnitY();
        const double sigma = part.norm() * (lost ? model.slip_mean + model.slip_sigma : model.step_sigma_ratio);
        variance += sigma * sigma;
        dead_reckoned_m += lost ? part.norm() : 0.0;
      }
      travelled_m += length;
      T.translation() += T.linear() * moved;
      yaw_error += model.yaw_rad_per_sqrt_m * std::sqrt(length) * random.gauss();
      tilt =
          0.95 * tilt + std::sqrt(1.0 - 0.95 * 0.95) * model.tilt_rad * Eigen::Vector2d(random.gauss(), random.gauss());
      const Eigen::Vector3d rpy = rpy_of(drive[i].T_map_body.linear());
      T.linear() =
          rotation_from_rpy(rpy.x() + tilt.x(), rpy.y() + tilt.y(), wrap_angle(rpy.z() - first_yaw + yaw_error));
    }
    track.T_odom_body.push_back(T);
    track.dead_reckoned_m.push_back(dead_reckoned_m);
    track.sigma_m.push_back(std::sqrt(variance + 0.003 * 0.003 * travelled_m * travelled_m));
  }
  return track;
}

}  // namespace rover::slam::study
