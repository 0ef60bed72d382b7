// ROS: sensor_msgs/CameraInfo of two cameras, as camera_calibration stores it (camera_matrix with data ...) or as
// `rostopic echo` and `ros2 topic echo` show it (K or k ...). P = [f 0 cx -f baseline; ...] of the right camera,
// x_rectified = R x_camera.
#include <cmath>

#include "tools/calibration/read.hpp"

namespace rover::calibration {
namespace {

const std::vector<std::string> kK = {"camera_matrix", "K", "k"};
const std::vector<std::string> kD = {"distortion_coefficients", "D", "d"};
const std::vector<std::string> kR = {"rectification_matrix", "R", "r"};
const std::vector<std::string> kP = {"projection_matrix", "P", "p"};

PinholeCamera camera_of(const ToolFile& info) {
  const std::vector<double> K = info.numbers(info.name_of(kK), 9);
  PinholeCamera camera{K[0], K[4], K[2], K[5], {}};
  info.set_lens(camera, info.text("distortion_model"), info.name_of(kD));
  return camera;
}

// Baseline: distance of the rectified right camera from the left one.
double offset_m(const ToolFile& info) {
  const std::vector<double> P = info.numbers(info.name_of(kP), 12);
  if (!(P[0] > 1.0)) info.fail(info.name_of(kP), "no focal length");
  return -P[3] / P[0];
}

Eigen::Matrix3d rectification(const ToolFile& info) {
  const std::vector<double> R = info.numbers(info.name_of(kR), 9);
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(R.data());
}

}  // namespace

bool is_camera_info(const ToolFile& file) {
  return file.has("distortion_model") && file.has(file.name_of(kK)) && file.has(file.name_of(kP));
}

StereoCalibration read_camera_info(const ToolFile& left, const ToolFile& right) {
  StereoCalibration out;
  out.left = camera_of(left);
  out.right = camera_of(right);
  out.width = left.size_px(left.name_of({"image_width", "width"}));
  out.height = left.size_px(left.name_of({"image_height", "height"}));
  if (right.size_px(right.name_of({"image_width", "width"})) != out.width ||
      right.size_px(right.name_of({"image_height", "height"})) != out.height)
    right.fail("image_width", "the image size differs from that of " + left.file());
  const double left_m = offset_m(left);
  const double baseline_m = offset_m(right) - left_m;
  const bool apart = std::abs(baseline_m) > 1e-4;
  if (left_m != 0.0 && !apart) left.fail(left.name_of(kP), "is the right camera's: its fourth number must be 0");
  if (!apart)
    right.fail(right.name_of(kP), "the fourth number, -f * baseline, is 0: calibrate the cameras as a stereo pair");
  const Eigen::Matrix3d R_rect_left = rectification(left);
  const Eigen::Matrix3d R_rect_right = rectification(right);
  out.T_left_right.linear() = R_rect_left.transpose() * R_rect_right;
  out.T_left_right.translation() = R_rect_left.transpose() * Eigen::Vector3d(baseline_m, 0.0, 0.0);
  return out;
}

}  // namespace rover::calibration
