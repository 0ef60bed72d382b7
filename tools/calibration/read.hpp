// Calibration files of other tools. All throw ConfigError with one line that names the file and the key.
#pragma once

#include <string>
#include <vector>

#include "tools/calibration/stereo_calibration.hpp"
#include "tools/calibration/tool_file.hpp"

namespace rover::calibration {

// Kalibr's camchain, also in OpenVINS's form: cam0 left, cam1 right.
StereoCalibration read_kalibr(const ToolFile& file);

// OpenCV's: M1 D1 M2 D2 R T of the stereo_calib sample, in one file or in several. `model`: radtan or equidistant,
// where the files do not tell, else empty.
bool is_opencv_stereo(const ToolFile& file);
StereoCalibration read_opencv(const std::vector<ToolFile>& files, const std::string& model);

// ROS's camera_info of a calibrated stereo pair.
bool is_camera_info(const ToolFile& file);
StereoCalibration read_camera_info(const ToolFile& left, const ToolFile& right);

// Whichever of these it is, by its keys. What cannot be is refused: baseline in millimetres, left and right exchanged,
// principal point outside of the picture.
StereoCalibration read_calibration(const std::vector<std::string>& files, const std::string& model = {});

}  // namespace rover::calibration
