#include "tools/calibration/cameras_yaml.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <cmath>

#include "common/bus/vehicle_config.hpp"
#include "common/bus/yaml_file.hpp"
#include "common/core/frames.hpp"

namespace rover::calibration {
namespace {

// Avoids "-0".
double tidy(double value) {
  return std::abs(value) < 5e-8 ? 0.0 : value;
}

std::string list(const Eigen::Vector3d& v, int decimals) {
  return fmt::format("[{:.{}f}, {:.{}f}, {:.{}f}]", tidy(v.x()), decimals, tidy(v.y()), decimals, tidy(v.z()),
                     decimals);
}

std::string pinhole(const PinholeCamera& c) {
  const auto& d = c.distortion;
  const std::string fifth = c.model == DistortionModel::kRadTan ? fmt::format(", {:.7f}", d[4]) : "";
  return fmt::format(
      "{{fx_px: {:.4f}, fy_px: {:.4f}, cx_px: {:.4f}, cy_px: {:.4f}, distortion: [{:.7f}, {:.7f}, {:.7f}, {:.7f}{}]}}",
      c.fx_px, c.fy_px, c.cx_px, c.cy_px, d[0], d[1], d[2], d[3], fifth);
}

std::string section(const std::string& name, const StereoCalibration& c, const Mount& mount) {
  const Eigen::Vector3d rpy_deg = rpy_of(c.T_left_right.linear()) * (180.0 / kPi);
  return fmt::format(
      "{}:\n  width_px: {}\n  height_px: {}\n  distortion_model: {}\n  left:  {}\n  right: {}\n"
      "  right_in_left: {{position_m: {}, rpy_deg: {}}}   # in left camera axes\n"
      "  left_in_body: {{position_m: {}, pitch_down_deg: {:.4f}, roll_deg: {:.4f}, yaw_deg: {:.4f}}}\n",
      name, c.width, c.height, name_of(c.left.model), pinhole(c.left), pinhole(c.right),
      list(c.T_left_right.translation(), 6), list(rpy_deg, 5), list(mount.position_m, 4),
      tidy(to_deg(mount.pitch_down_rad)), tidy(to_deg(mount.roll_rad)), tidy(to_deg(mount.yaw_rad)));
}

}  // namespace

std::string cameras_yaml(const std::string& file, const std::string& camera, const StereoCalibration& calibration,
                         const Mount& mount, const std::string& source) {
  const YAML::Node root = load_yaml(file);
  std::string out = "# Calibration of the cameras. " + camera + ": " + source + ".\n";
  for (const auto& entry : root) {
    const auto name = entry.first.as<std::string>();
    if (name == camera) continue;
    YAML::Node other;
    other[name] = entry.second;
    out += YAML::Dump(other) + "\n";
  }
  return out + section(camera, calibration, mount);
}

}  // namespace rover::calibration
