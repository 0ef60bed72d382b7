// Camera pose over flat ground, from which the disparity look-up table is computed.
#pragma once

#include <optional>

#include "common/core/image.hpp"

namespace rover::hazard {

// Rectified left camera over flat ground, with the rover level.
struct GroundCalibration {
  double height_m = 0.0;
  double pitch_rad = 0.0;  // positive down
  double roll_rad = 0.0;
};

// From the camera mount and the height of the body origin over flat ground.
GroundCalibration nominal_calibration(const StereoCamera& camera, double origin_height_m);

// Replaces height, pitch and roll of the camera by the calibration; x, y and yaw stay those of the mount.
StereoCamera calibrated_camera(StereoCamera camera, const GroundCalibration& calibration, double origin_height_m);

}  // namespace rover::hazard
