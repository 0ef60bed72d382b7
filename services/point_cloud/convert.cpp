#include "point_cloud/convert.hpp"

#include <cmath>

#include "common/bus/convert.hpp"

namespace rover::cloud {

std::string fault_of(const ptu_state_t& message, const PanTiltUnit& unit) {
  constexpr double kSlack = to_rad(2.0);  // zero offset of the unit
  if (!std::isfinite(message.pan_rad) || !std::isfinite(message.tilt_rad)) return "not finite";
  const double pan_excess = message.pan_rad - unit.clamp_pan(message.pan_rad);
  const double tilt_excess = message.tilt_rad - unit.clamp_tilt(message.tilt_rad);
  return std::max(std::abs(pan_excess), std::abs(tilt_excess)) > kSlack ? "beyond the unit's limits" : "";
}

void cloud_to(const CloudResult& result, cloud_t& message) {
  pose_to(result.T_body_cam, message.position_body_cam_m, message.quat_body_cam_wxyz);
  const size_t count = result.cloud.size();
  message.point_count = static_cast<std::int32_t>(count);
  for (std::vector<float>* values :
       {&message.x_m, &message.y_m, &message.z_m, &message.depth_sigma_m, &message.brightness}) {
    values->clear();
    values->reserve(count);
  }
  for (const Point& point : result.cloud) {
    message.x_m.push_back(point.x_m);
    message.y_m.push_back(point.y_m);
    message.z_m.push_back(point.z_m);
    message.depth_sigma_m.push_back(point.depth_sigma_m);
    if (std::isfinite(point.brightness)) message.brightness.push_back(point.brightness);
  }
  // All points of a cloud are from one picture, or from none.
  message.picture_size = static_cast<std::int32_t>(message.brightness.size());
}

}  // namespace rover::cloud
