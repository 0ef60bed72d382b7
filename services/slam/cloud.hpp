// A cloud as the core takes it, and the same cloud laid level around the rover.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "common/core/frames.hpp"
#include "common/core/time.hpp"

namespace rover::slam {

struct CameraPoint {
  Eigen::Vector3f p_cam_m;     // z forward, x right, y down
  float depth_sigma_m = 0.0F;  // along the camera's axis, from the distance to the camera
};

struct Cloud {
  Utime utime = kNever;
  Eigen::Isometry3d T_body_cam = Eigen::Isometry3d::Identity();
  std::vector<CameraPoint> points;
};

// A point about the body's origin in level axes: x along the rover's heading, z up against gravity. It does not know
// where in the world the rover is.
struct LevelPoint {
  float x_m = 0.0F;
  float y_m = 0.0F;
  float z_m = 0.0F;
  float variance_m2 = 0.0F;  // of z, from the camera and the attitude
  float ray_x_m = 0.0F;      // how far the point moves by one sigma of its depth
  float ray_y_m = 0.0F;
};

struct AttitudeNoise {
  double tilt_rad = 0.0015;  // roll and pitch against gravity, from one cloud to the next
  double height_m = 0.003;   // of the body's origin
};

struct LevelCloud {
  Eigen::Vector3f camera_m = Eigen::Vector3f::Zero();  // in the points' axes
  std::vector<LevelPoint> points;
};

// Roll and pitch of T_odom_body are used, its place and heading are not.
LevelCloud level(const Cloud& cloud, const Eigen::Isometry3d& T_odom_body, const AttitudeNoise& noise);

}  // namespace rover::slam
