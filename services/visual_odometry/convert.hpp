// Messages of visual odometry to and from core types.
#pragma once

#include <rover/imu_t.hpp>
#include <rover/vo_motion_t.hpp>

#include "visual_odometry/odometry.hpp"
#include "visual_odometry/rotation_buffer.hpp"

namespace rover::vo {

// z from the fibre-optic gyro if it is finite.
GyroIncrement gyro_from(const imu_t& message);
// Finite and physically plausible.
bool is_valid(const StereoCamera& camera);
// Images, disparity and camera have the same size.
bool sizes_match(const StereoFrame& frame);
void motion_to(const OdometryResult& result, vo_motion_t& message);

}  // namespace rover::vo
