// Simulated drives for the study: what the NavCam would see each half metre, and what odometry would say meanwhile.
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

// Over the DTM with rocks of the law, the seed's own place and rocks.
std::vector<Station> simulated_drive(const DriveConfig& config, const std::string& dtm_file);

struct OdometryModel {
  double scale_sigma = 0.003;                  // constant over a drive
  double step_share = 0.004;                   // of each way between two frames, at random
  double yaw_rad_per_sqrt_m = to_rad(0.005);   // fibre-optic gyro: 1e-5 rad/sqrt(s) (localization.yaml), and its bias
  double tilt_rad = 0.001;                     // slowly wandering error of roll and pitch
  double lost_share = 0.0;                     // of the frames: wheels bridge
  double slip_mean = 0.05, slip_sigma = 0.06;  // of the wheels' way where they bridge
};
OdometryModel nominal_odometry();
OdometryModel degraded_odometry();

struct OdometryTrack {
  std::vector<Eigen::Isometry3d> T_odom_body;  // at the stations
  std::vector<double> sigma_m;                 // what its filter would say of the position
  std::vector<double> blind_way_m;             // so far, on which wheels bridged
};
OdometryTrack simulated_odometry(const std::vector<Station>& drive, const OdometryModel& model, std::uint64_t seed);

}  // namespace rover::slam::study
