// Simulated drive with the elevation maps that mapping would build: NavCam visibility (occlusion, textureless patches,
// lost points and images), stereo errors, attitude errors and odometry drift.
#pragma once

#include <Eigen/Geometry>
#include <random>
#include <vector>

#include "global_localization/local_mosaic.hpp"
#include "rover_simulator/world/world.hpp"

namespace rover::global::test {

// Odometry errors: about 1.5 times those of a recorded 107 m drive among rocks (over 40 m: 0.04 m along and across,
// 0.02 deg, 0.017 m in height; roll and pitch 0.05 deg).
struct DriveErrors {
  double depth_sigma_per_m2 = 0.001;  // 0.2 px at a baseline of 0.24 m and a focal length of 818 px
  double depth_bias_per_m2 = 0.0005;  // calibration
  double attitude_sigma_rad = 0.001;  // per image
  double scale_sigma = 0.0015;        // constant scale error of the drive
  double yaw_walk_rad_rtm = 0.00015;
  double height_walk_m_rtm = 0.003;
  double untextured_fraction = 0.08;
  double lost_points = 0.05;
  double lost_pictures = 0.05;
  double exposure_sigma = 0.05;    // relative, per image
  double brightness_sigma = 0.02;  // relative, per point
};

struct Line {
  Eigen::Vector2d start = Eigen::Vector2d::Zero();
  double heading_rad = 0.0;
  double wave_m = 6.0;  // amplitude
  double wave_length_m = 50.0;

  Eigen::Vector2d at(double s_m) const;
};

class MappedDrive {
 public:
  // `ground`: radiance, for the brightness of the views; null: they have none.
  MappedDrive(const Surface& world, const Line& line, const DriveErrors& errors, std::uint64_t seed,
              const ElevationRaster* ground = nullptr);

  // Drives 0.5 m and takes an image.
  void advance();

  const ElevationView& view() const { return view_; }  // 20 x 20 m about the rover, in odom
  const Eigen::Isometry2d& T_map_body() const { return T_map_body_; }
  const Eigen::Isometry2d& T_odom_body() const { return T_odom_body_; }
  Eigen::Isometry2d T_map_odom() const { return T_map_body_ * T_odom_body_.inverse(); }
  double driven_m() const { return s_m_; }
  // True positions of the terrain observed within this distance along x and y, on a 0.5 m grid.
  std::vector<Eigen::Vector2d> seen_ground(double reach_m) const;

 private:
  struct Ground {
    float z = 0.0f, variance = 0.0f, brightness = 0.0f;
    bool seen = false;
  };
  struct Viewpoint;  // camera pose of one image

  double normal(double sigma);
  void move(double step_m);
  void look(double pan_rad);
  void look_along(const Viewpoint& viewpoint, double azimuth_rad);
  void measure(const Viewpoint& viewpoint, const Eigen::Vector3d& p_map);
  void publish();

  float brightness_at(const Eigen::Vector2d& p_map);

  const Surface& world_;
  const ElevationRaster* ground_;
  Line line_;
  DriveErrors errors_;
  std::uint64_t seed_;
  std::mt19937_64 random_;
  double s_m_ = 0.0;
  double scale_ = 1.0;
  double yaw_drift_rad_ = 0.0;
  double height_drift_m_ = 0.0;
  double exposure_ = 1.0;
  Eigen::Isometry2d T_map_body_ = Eigen::Isometry2d::Identity();
  Eigen::Isometry2d T_odom_body_ = Eigen::Isometry2d::Identity();
  GridMap<Ground> map_;          // odom
  GridMap<std::uint8_t> known_;  // map frame, half-metre cells
  ElevationView view_;
};

}  // namespace rover::global::test
