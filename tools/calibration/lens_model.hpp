// Lens models by the names that Kalibr, EuRoC, ROS and OpenCV give them.
#pragma once

#include <string>
#include <vector>

#include "common/core/camera_rig.hpp"

namespace rover::calibration {

// Sets the camera's model and coefficients. What cannot be taken is said in words, empty: it was.
std::string set_lens(PinholeCamera& camera, const std::string& model, const std::vector<double>& coefficients);

}  // namespace rover::calibration
