// Where the camera stands over flat ground: what makes the look-up table of tolerated disparities.
#pragma once

#include <optional>

#include "common/core/image.hpp"

namespace rover::hazard {

// Of the rectified left camera over flat ground, with the rover level.
struct GroundCalibration {
  double height_m = 0.0;
  double pitch_rad = 0.0;  // positive down
  double roll_rad = 0.0;
};

// Nominal calibration: from the camera's mount and the height of the body origin over flat ground.
GroundCalibration nominal_calibration(const StereoCamera& camera, double ground_below_m);

// The camera with height, pitch and roll from the calibration; x, y and yaw stay those of the mount.
StereoCamera calibrated_camera(StereoCamera camera, const GroundCalibration& calibration, double ground_below_m);

}  // namespace rover::hazard
