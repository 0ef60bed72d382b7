// Messages of visual odometry to and from core types.
#pragma once

#include <rover/imu_t.hpp>
#include <rover/vo_motion_t.hpp>

#include "visual_odometry/odometry.hpp"
#include "visual_odometry/rotation_buffer.hpp"

namespace rover::vo {

// About the body's z axis the fibre-optic gyro, where it gives a number.
GyroIncrement gyro_from(const imu_t& message);
// Usable for geometry: finite, and with numbers a camera can have.
bool sound(const StereoCamera& camera);
// Images, disparity and camera are of one size.
bool consistent(const StereoFrame& frame);
void motion_to(const OdometryResult& result, vo_motion_t& message);

}  // namespace rover::vo
