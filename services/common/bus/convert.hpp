// Conversion between message arrays and core types.
#pragma once

#include <Eigen/Geometry>
#include <rover/disparity_t.hpp>
#include <rover/drive_permit_t.hpp>
#include <rover/image_t.hpp>
#include <rover/motion_command_t.hpp>

#include "common/core/frames.hpp"
#include "common/core/image.hpp"
#include "common/core/lease.hpp"

namespace rover {

Eigen::Isometry3d pose_from(const double position_m[3], const double quat_wxyz[4]);
void pose_to(const Eigen::Isometry3d& T, double position_m[3], double quat_wxyz[4]);
Matrix6d matrix6_from(const double values[36]);
void matrix6_to(const Matrix6d& m, double values[36]);

// Empty image if the message is inconsistent (size, encoding).
GrayImage image_from(const image_t& message);
void image_to(const GrayImage& image, image_t& message);

// Empty disparity if the message is inconsistent.
Disparity disparity_from(const disparity_t& message);
StereoCamera camera_from(const disparity_t& message);
void disparity_to(const Disparity& disparity, const StereoCamera& camera, disparity_t& message);

MotionCommand command_from(const motion_command_t& message);
DrivePermit permit_from(const drive_permit_t& message);

}  // namespace rover
