// Simulated drives for slam_study: a NavCam cloud every half metre, and an odometry error model.
#pragma once

#include <string>
#include <vector>

#include "test/slam/navcam.hpp"

namespace rover::slam::study {

struct DriveConfig {
  double length_m = 100.0;
  double step_m = 0.5;
  double rock_k = 0.08;
  bool flat = false;  // a plane without rocks or roughness
  double disparity_offset_px = 0.0;
  std::uint64_t seed = 1;
};

struct Station {
  Eigen::Isometry3d T_map_body;  // truth
  Cloud cloud;
};

// On the DTM; the seed selects start, track and rocks.
std::vector<Station> simulated_drive(const DriveConfig& config, const std::string& dtm_file);

struct OdometryModel {
  double scale_sigma = 0.003;                  // constant over a drive
  double step_sigma_ratio = 0.004;             // of the motion between two frames, random
  double yaw_rad_per_sqrt_m = to_rad(0.005);   // fibre-optic gyro (localization.yaml: 1e-5 rad/sqrt(s)) with bias
  double tilt_rad = 0.001;                     // slowly varying error of roll and pitch
  double lost_fraction = 0.0;                  // share of frames without visual odometry
  double slip_mean = 0.05, slip_sigma = 0.06;  // of the wheels in those frames
};
OdometryModel nominal_odometry();
OdometryModel degraded_odometry();

struct OdometryTrack {
  std::vector<Eigen::Isometry3d> T_odom_body;  // at the stations
  std::vector<double> sigma_m;                 // reported standard deviation of the position
  std::vector<double> dead_reckoned_m;         // cumulative
};
OdometryTrack simulated_odometry(const std::vector<Station>& drive, const OdometryModel& model, std::uint64_t seed);

}  // namespace rover::slam::study
