// Lens models by their names in Kalibr, EuRoC, ROS and OpenCV.
#pragma once

#include <string>
#include <vector>

#include "common/core/camera_rig.hpp"

namespace rover::calibration {

// Sets model and coefficients. Returns the reason if unsupported, else an empty text.
std::string set_lens(PinholeCamera& camera, const std::string& model, const std::vector<double>& coefficients);

}  // namespace rover::calibration
