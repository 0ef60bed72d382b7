// github.com/ethz-asl/kalibr/wiki/yaml-formats: cam0 and cam1 with camera_model, intrinsics [fu fv pu pv],
// distortion_model, distortion_coeffs, resolution, T_cn_cnm1 (from the camera before into this one) and, with an IMU,
// T_cam_imu (from the IMU into the camera). OpenVINS's form of it has T_imu_cam instead of both.
#include "tools/calibration/read.hpp"

namespace rover::calibration {
namespace {

PinholeCamera camera_of(const ToolFile& camera) {
  const std::string model = camera.text("camera_model");
  if (model != "pinhole") camera.fail("camera_model", "the model '" + model + "' is not supported; pinhole is");
  const std::vector<double> f = camera.numbers("intrinsics", 4);
  PinholeCamera out{f[0], f[1], f[2], f[3], {}};
  camera.set_lens(out, camera.text("distortion_model"), "distortion_coeffs");
  return out;
}

std::optional<Eigen::Isometry3d> T_camera_imu(const ToolFile& camera) {
  if (camera.has("T_cam_imu")) return camera.pose("T_cam_imu");
  if (camera.has("T_imu_cam")) return camera.pose("T_imu_cam").inverse();
  return std::nullopt;
}

Eigen::Isometry3d T_left_right(const ToolFile& left, const ToolFile& right) {
  if (right.has("T_cn_cnm1")) return right.pose("T_cn_cnm1").inverse();
  const auto T_left_imu = T_camera_imu(left);
  const auto T_right_imu = T_camera_imu(right);
  if (!T_left_imu || !T_right_imu)
    right.fail("T_cn_cnm1", "missing; it, or T_imu_cam or T_cam_imu of both cameras, is expected");
  return *T_left_imu * T_right_imu->inverse();
}

}  // namespace

StereoCalibration read_kalibr(const ToolFile& file) {
  const ToolFile left = file.section("cam0");
  const ToolFile right = file.section("cam1");
  StereoCalibration out;
  out.left = camera_of(left);
  out.right = camera_of(right);
  if (left.has("resolution")) {
    const std::vector<double> size = left.numbers("resolution", 2);
    if (right.numbers("resolution", 2) != size) right.fail("resolution", "differs between the cameras");
    if (size[0] < 1 || size[0] > 8192 || size[1] < 1 || size[1] > 8192) left.fail("resolution", "not an image size");
    out.width = static_cast<int>(size[0]);
    out.height = static_cast<int>(size[1]);
  }
  out.T_left_right = T_left_right(left, right);
  out.T_left_imu = T_camera_imu(left);
  return out;
}

}  // namespace rover::calibration
