// Messages of localization to and from core types.
#pragma once

#include <rover/correction_t.hpp>
#include <rover/ground_command_t.hpp>
#include <rover/imu_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/slam_pose_t.hpp>
#include <rover/slip_t.hpp>
#include <rover/vo_motion_t.hpp>
#include <rover/wheel_command_t.hpp>
#include <rover/wheel_state_t.hpp>

#include "localization/localization.hpp"

namespace rover::loc {

ImuSample imu_from(const imu_t& message);
WheelSample wheels_from(const wheel_state_t& message);
WheelCommand wheel_command_from(const wheel_command_t& message);
VisualMotion visual_from(const vo_motion_t& message);
StartPose start_pose_from(const ground_command_t& message);
MapMeasurement measurement_from(const slam_pose_t& message);
MapMeasurement measurement_from(const correction_t& message);
void pose_to(const PoseEstimate& pose, pose_t& message);
void slip_to(const Slip& slip, slip_t& message);

}  // namespace rover::loc
