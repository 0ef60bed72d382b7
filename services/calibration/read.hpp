// Calibration files of other tools. All throw ConfigError with one line that names the file and the key.
#pragma once

#include <string>
#include <vector>

#include "calibration/stereo_calibration.hpp"

namespace rover::calibration {

// Kalibr's camchain: cam0 left, cam1 right.
StereoCalibration read_kalibr(const std::string& file);
// OpenCV's FileStorage: M1 D1 M2 D2 R T of the stereo_calib sample, in one file or in several.
StereoCalibration read_opencv(const std::vector<std::string>& files);
// Whichever of the two it is.
StereoCalibration read_calibration(const std::vector<std::string>& files);

}  // namespace rover::calibration
