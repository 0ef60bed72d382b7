// Readers of calibration files of other tools. All throw ConfigError with one line that names file and key.
#pragma once

#include <string>
#include <vector>

#include "tools/calibration/stereo_calibration.hpp"
#include "tools/calibration/tool_file.hpp"

namespace rover::calibration {

// Kalibr camchain, also in OpenVINS form: cam0 left, cam1 right.
StereoCalibration read_kalibr(const ToolFile& file);

// OpenCV: M1 D1 M2 D2 R T of the stereo_calib sample, in one or several files. `model`: radtan, equidistant or empty
// (from the file).
bool is_opencv_stereo(const ToolFile& file);
StereoCalibration read_opencv(const std::vector<ToolFile>& files, const std::string& model);

// ROS camera_info of a calibrated stereo pair.
bool is_camera_info(const ToolFile& file);
StereoCalibration read_camera_info(const ToolFile& left, const ToolFile& right);

// Detects the format by its keys. Refuses implausible rigs: baseline in mm, left and right swapped, principal point
// outside.
StereoCalibration read_calibration(const std::vector<std::string>& files, const std::string& model = {});

}  // namespace rover::calibration
