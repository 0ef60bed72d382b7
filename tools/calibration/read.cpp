#include "tools/calibration/read.hpp"

#include "common/bus/config.hpp"
#include "common/bus/vehicle_config.hpp"

namespace rover::calibration {
namespace {

void check_camera(const PinholeCamera& c, const StereoCalibration& pair, const std::string& where) {
  if (!(c.fx_px >= 10.0 && c.fx_px <= 1e5 && c.fy_px >= 10.0 && c.fy_px <= 1e5))
    throw ConfigError(where + ": focal lengths of " + std::to_string(c.fx_px) + " and " + std::to_string(c.fy_px) +
                      " px; 10 to 100000 px are expected");
  if (pair.width > 0 && pair.height > 0 &&
      !(c.cx_px > 0.0 && c.cx_px < pair.width && c.cy_px > 0.0 && c.cy_px < pair.height))
    throw ConfigError(where + ": the principal point is outside of the picture of " + std::to_string(pair.width) +
                      " x " + std::to_string(pair.height) + " px");
}

// Plausibility checks for all formats.
void check(const StereoCalibration& c, const std::string& file) {
  check_camera(c.left, c, file + ": left camera");
  check_camera(c.right, c, file + ": right camera");
  if (c.left.model != c.right.model)
    throw ConfigError(file + ": one camera is " + name_of(c.left.model) + ", the other " + name_of(c.right.model) +
                      "; calibrate both with one model");
  const std::string problem = problem_of_pair(c.T_left_right);
  if (!problem.empty()) throw ConfigError(file + ": " + problem);
}

StereoCalibration read_by_keys(const std::vector<ToolFile>& files, const std::string& model) {
  const ToolFile& first = files.front();
  if (first.has("cam0") || is_camera_info(first)) {
    if (!model.empty()) throw ConfigError(first.file() + ": specifies its own model; omit --model");
    const size_t count = first.has("cam0") ? 1 : 2;
    if (files.size() > count) throw ConfigError(files[count].file() + ": one file too many");
    if (count == 1) return read_kalibr(first);
    if (files.size() < count || !is_camera_info(files.back()))
      throw ConfigError(files.back().file() +
                        ": camera_info of the left and of the right camera are expected: two files");
    return read_camera_info(first, files.back());
  }
  for (const ToolFile& file : files) {
    if (is_opencv_stereo(file)) continue;
    if (file.has("camera_matrix"))
      throw ConfigError(file.file() + ": a calibration of only one camera; calibrate both as a stereo pair");
    throw ConfigError(file.file() +
                      ": neither a camchain of Kalibr's (cam0, cam1), nor OpenCV's M1 D1 M2 D2 R T, nor ROS's "
                      "camera_info (camera_matrix, distortion_model, projection_matrix)");
  }
  return read_opencv(files, model);
}

}  // namespace

StereoCalibration read_calibration(const std::vector<std::string>& files, const std::string& model) {
  if (files.empty()) throw ConfigError("calibration: no file");
  std::vector<ToolFile> loaded;
  for (const std::string& file : files) loaded.push_back(ToolFile::load(file));
  const StereoCalibration out = read_by_keys(loaded, model);
  check(out, files.front());
  return out;
}

}  // namespace rover::calibration
