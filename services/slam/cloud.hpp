// Point clouds: as measured by the camera, and rotated into gravity-aligned axes.
#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <vector>

#include "common/core/frames.hpp"
#include "common/core/time.hpp"

namespace rover::slam {

inline constexpr float kNoBrightness = std::numeric_limits<float>::quiet_NaN();

struct CameraPoint {
  Eigen::Vector3f p_cam_m;     // z forward, x right, y down
  float depth_sigma_m = 0.0F;  // along the optical axis
  float brightness = kNoBrightness;
};

struct Cloud {
  Utime utime = kNever;
  Eigen::Isometry3d T_body_cam = Eigen::Isometry3d::Identity();
  std::vector<CameraPoint> points;
};

// Relative to the body's origin, in gravity-aligned axes: x along the heading, z up. Independent of the rover's
// position in the world.
struct AlignedPoint {
  float x_m = 0.0F;
  float y_m = 0.0F;
  float z_m = 0.0F;
  float variance_m2 = 0.0F;  // of z, from depth, attitude and body height
  float ray_x_m = 0.0F;      // horizontal shift of the point by one sigma of depth
  float ray_y_m = 0.0F;
  float brightness = kNoBrightness;
};

struct AttitudeNoise {
  double tilt_rad = to_rad(0.086);  // of roll and pitch, cloud to cloud
  double height_m = 0.003;          // of the body's origin
};

struct AlignedCloud {
  Eigen::Vector3f camera_m = Eigen::Vector3f::Zero();  // in the axes of the points
  std::vector<AlignedPoint> points;
};

// Uses roll and pitch of T_odom_body only.
AlignedCloud align_to_gravity(const Cloud& cloud, const Eigen::Isometry3d& T_odom_body, const AttitudeNoise& noise);

}  // namespace rover::slam
