#include "traversability/convert.hpp"

#include <cmath>

#include "common/bus/convert.hpp"

namespace rover::trav {
namespace {

constexpr int kMaxCells = 1000;  // along a side
constexpr double kMaxPlaceM = 1e6;

bool in_range(double value, double low, double high) {
  return value >= low && value <= high;
}

}  // namespace

std::string fault_of(const elevation_t& message) {
  if (!in_range(message.cells_x, 3, kMaxCells) || !in_range(message.cells_y, 3, kMaxCells)) return "size out of range";
  const std::size_t size = static_cast<std::size_t>(message.cells_x) * static_cast<std::size_t>(message.cells_y);
  if (message.height_m.size() != size || message.sigma_m.size() != size) return "size contradicts the cells";
  if (!in_range(message.cell_m, 0.02, 1.0)) return "side of a cell is not usable";
  if (!in_range(message.origin_x_m, -kMaxPlaceM, kMaxPlaceM) || !in_range(message.origin_y_m, -kMaxPlaceM, kMaxPlaceM))
    return "origin is not usable";
  return "";
}

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
  message.difficulty = difficulty;
}

}  // namespace rover::trav
