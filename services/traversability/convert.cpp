#include "traversability/convert.hpp"

#include "common/bus/convert.hpp"

namespace rover::trav {
TerrainGrid grid_from(const elevation_t& message) {
  return {{message.cells_x, message.cells_y, message.cell_m, message.origin_x_m, message.origin_y_m},
          message.height_m,
          message.sigma_m};
}

Pose2 body_from(const pose_t& message) {
  const Eigen::Isometry3d T_odom_body = pose_from(message.position_odom_body_m, message.quat_odom_body_wxyz);
  const bool usable = is_finite(T_odom_body) && (message.status == pose_t::OK || message.status == pose_t::DEGRADED);
  return usable ? planar(T_odom_body) : Pose2{kNaN, kNaN, kNaN};
}

void traversability_to(const TraversabilityMap& map, double difficulty, traversability_t& message) {
  message.cell_m = map.shape.cell_m;
  message.origin_x_m = map.shape.origin_x_m;
  message.origin_y_m = map.shape.origin_y_m;
  message.cells_x = static_cast<std::int16_t>(map.shape.cells_x);
  message.cells_y = static_cast<std::int16_t>(map.shape.cells_y);
  message.size = static_cast<std::int32_t>(map.cells.size());
  message.cells = map.cells;
  message.step_percent = map.step_percent;
  message.height_m = map.height_m;
  message.difficulty = difficulty;
}

}  // namespace rover::trav
