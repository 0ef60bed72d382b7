#include "calibration/read.hpp"

#include <cmath>
#include <fstream>

#include "common/bus/config.hpp"
#include "common/core/frames.hpp"

namespace rover::calibration {
namespace {

constexpr double kMostBaselineM = 5.0;
constexpr double kLeastBaselineM = 0.005;

// OpenCV's writer begins with a directive that YAML 1.2 readers refuse.
bool is_opencv(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw ConfigError(file + ": cannot be read");
  std::string line;
  std::getline(in, line);
  return line.rfind("%YAML:1.0", 0) == 0 || line.rfind("<?xml", 0) == 0;
}

// Whatever the tool: a rig that cannot be is not handed on.
void check(const StereoCalibration& c, const std::string& file) {
  const Eigen::Vector3d& p = c.T_left_right.translation();
  if (!is_finite(c.T_left_right)) throw ConfigError(file + ": the right camera's pose is not finite");
  if (p.norm() < kLeastBaselineM || p.norm() > kMostBaselineM)
    throw ConfigError(file + ": a baseline of " + std::to_string(p.norm()) +
                      " m; metres are expected (the square's size that was given to the calibration?)");
  if (p.x() < 0.5 * p.norm())
    throw ConfigError(file + ": the second camera is not to the right of the first one; exchange left and right");
  const Eigen::Matrix3d& R = c.T_left_right.linear();
  if ((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() > 1e-3 || R.determinant() < 0.0)
    throw ConfigError(file + ": the rotation between the cameras is none");
}

}  // namespace

StereoCalibration read_calibration(const std::vector<std::string>& files) {
  if (files.empty()) throw ConfigError("calibration: no file");
  const bool opencv = is_opencv(files.front());
  for (const std::string& file : files)
    if (is_opencv(file) != opencv) throw ConfigError(file + ": is of another tool than " + files.front());
  if (!opencv && files.size() > 1) throw ConfigError(files[1] + ": one file of Kalibr's is enough");
  const StereoCalibration out = opencv ? read_opencv(files) : read_kalibr(files.front());
  check(out, files.front());
  return out;
}

}  // namespace rover::calibration
