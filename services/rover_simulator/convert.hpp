// Conversion between simulator types and messages.
#pragma once

#include <rover/image_t.hpp>
#include <rover/imu_t.hpp>
#include <rover/ptu_command_t.hpp>
#include <rover/ptu_state_t.hpp>
#include <rover/truth_t.hpp>
#include <rover/wheel_command_t.hpp>
#include <rover/wheel_state_t.hpp>

#include "common/core/image.hpp"
#include "rover_simulator/vehicle/pan_tilt_sim.hpp"
#include "rover_simulator/vehicle/sensors.hpp"
#include "rover_simulator/vehicle/vehicle_sim.hpp"

namespace rover {

imu_t imu_message(const ImuSample& sample);
wheel_state_t wheel_state_message(const WheelSample& sample, bool command_expired);
truth_t truth_message(const VehicleTruth& truth);
image_t image_message(const GrayImage& image, double exposure_s);
ptu_state_t ptu_state_message(const PanTiltState& state);
PanTiltCommand pan_tilt_command_from(const ptu_command_t& message);
WheelCommand wheel_command_from(const wheel_command_t& message);

}  // namespace rover
