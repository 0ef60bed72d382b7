#include "hazard_detector/convert.hpp"

#include <cmath>

#include "common/bus/convert.hpp"

namespace rover::hazard {

std::string validation_error(const disparity_t& message) {
  if (disparity_from(message).px16.empty()) return "size contradicts width and height";
  const bool lens = message.focal_px > 1.0 && std::isfinite(message.focal_px) && message.baseline_m > 0.0 &&
                    std::isfinite(message.baseline_m) && std::isfinite(message.cx_px) && std::isfinite(message.cy_px);
  if (!lens) return "camera is not usable";
  double squares = 0.0;
  for (double q : message.quat_body_cam_wxyz) squares += q * q;
  bool mount = std::abs(squares - 1.0) < 1e-3;
  for (double p : message.position_body_cam_m) mount = mount && std::abs(p) < 10.0;
  if (!mount) return "camera's mount is not usable";
  return "";
}

void hazards_to(const HazardResult& result, const GridShape& shape, hazards_t& message) {
  message.state = static_cast<std::int8_t>(result.status);
  message.coverage = static_cast<float>(result.coverage);
  message.hazard_px = result.hazard_px;
  message.nearest_hazard_m = result.nearest_hazard_m;
  message.plane_pitch_rad = result.plane.pitch_rad();
  message.plane_roll_rad = result.plane.roll_rad();
  message.cell_m = shape.cell_m;
  message.origin_x_m = shape.origin_x_m;
  message.origin_y_m = shape.origin_y_m;
  message.cells_x = static_cast<std::int16_t>(shape.cells_x);
  message.cells_y = static_cast<std::int16_t>(shape.cells_y);
  message.size = shape.size();
  message.cells.clear();
  for (Cell cell : result.cells) message.cells.push_back(static_cast<std::uint8_t>(cell));
}

}  // namespace rover::hazard
