// github.com/ethz-asl/kalibr/wiki/yaml-formats: cam0 and cam1 with camera_model, intrinsics [fu fv pu pv],
// distortion_model, distortion_coeffs, resolution, T_cn_cnm1 (from the camera before into this one) and, with an IMU,
// T_cam_imu (from the IMU into the camera).
#include <yaml-cpp/yaml.h>

#include <cmath>

#include "calibration/read.hpp"
#include "common/bus/config.hpp"
#include "common/core/frames.hpp"

namespace rover::calibration {
namespace {

[[noreturn]] void fail(const std::string& file, const std::string& key, const std::string& what) {
  throw ConfigError(file + ": " + key + ": " + what);
}

std::vector<double> numbers(const YAML::Node& camera, const std::string& file, const std::string& key, size_t count) {
  try {
    const auto values = camera[key].as<std::vector<double>>();
    if (values.size() == count) return values;
    fail(file, key, std::to_string(values.size()) + " numbers instead of " + std::to_string(count));
  } catch (const YAML::Exception&) {
    fail(file, key, "missing, or no list of numbers");
  }
}

void expect(const YAML::Node& camera, const std::string& file, const std::string& key, const std::string& value) {
  const std::string found = camera[key] && camera[key].IsScalar() ? camera[key].as<std::string>() : "missing";
  if (found != value) fail(file, key, "'" + found + "'; only " + value + " is known here");
}

PinholeCamera camera_of(const YAML::Node& camera, const std::string& file) {
  expect(camera, file, "camera_model", "pinhole");
  expect(camera, file, "distortion_model", "radtan");
  const auto intrinsics = numbers(camera, file, "intrinsics", 4);
  const auto distortion = numbers(camera, file, "distortion_coeffs", 4);
  return {intrinsics[0],
          intrinsics[1],
          intrinsics[2],
          intrinsics[3],
          {distortion[0], distortion[1], distortion[2], distortion[3], 0.0}};
}

Eigen::Isometry3d pose(const YAML::Node& camera, const std::string& file, const std::string& key) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  try {
    const auto rows = camera[key].as<std::vector<std::vector<double>>>();
    if (rows.size() != 4) fail(file, key, "no 4 x 4 matrix");
    for (int r = 0; r < 4; ++r) {
      if (rows[static_cast<size_t>(r)].size() != 4) fail(file, key, "no 4 x 4 matrix");
      for (int c = 0; c < 4; ++c) T.matrix()(r, c) = rows[static_cast<size_t>(r)][static_cast<size_t>(c)];
    }
  } catch (const YAML::Exception&) {
    fail(file, key, "missing, or no 4 x 4 matrix");
  }
  return T;
}

}  // namespace

StereoCalibration read_kalibr(const std::string& file) {
  YAML::Node root;
  try {
    root = YAML::LoadFile(file);
  } catch (const YAML::Exception& error) {
    throw ConfigError(file + ":" + std::to_string(error.mark.line + 1) + ": not valid YAML: " + error.msg);
  }
  if (!root.IsMap() || !root["cam0"].IsDefined() || !root["cam1"].IsDefined() || !root["cam0"].IsMap() ||
      !root["cam1"].IsMap())
    throw ConfigError(file + ": neither a camchain of Kalibr's with cam0 and cam1 nor a file of OpenCV's");
  StereoCalibration out;
  out.left = camera_of(root["cam0"], file);
  out.right = camera_of(root["cam1"], file);
  const auto size = numbers(root["cam0"], file, "resolution", 2);
  if (numbers(root["cam1"], file, "resolution", 2) != size) fail(file, "resolution", "differs between the cameras");
  out.width = static_cast<int>(size[0]);
  out.height = static_cast<int>(size[1]);
  out.T_left_right = pose(root["cam1"], file, "T_cn_cnm1").inverse();
  if (root["cam0"]["T_cam_imu"].IsDefined()) out.T_left_imu = pose(root["cam0"], file, "T_cam_imu");
  return out;
}

}  // namespace rover::calibration
