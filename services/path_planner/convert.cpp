#include "path_planner/convert.hpp"

#include <cmath>

#include "common/bus/convert.hpp"
#include "common/bus/zone_list.hpp"

namespace rover::planning {

namespace {

static_assert(TraversabilityGrid::kLow == traversability_t::LOW &&
              TraversabilityGrid::kImpassable == traversability_t::IMPASSABLE &&
              TraversabilityGrid::kUnknown == traversability_t::UNKNOWN);

static_assert(static_cast<int>(PathKind::kRepair) == path_t::REPAIR &&
              static_cast<int>(PathKind::kContinuous) == path_t::CONTINUOUS &&
              static_cast<int>(PathKind::kBacktrack) == path_t::BACKTRACK);

template <class Grid, class Message>
Grid grid_from(const Message& message) {
  Grid out;
  out.utime = message.header.utime;
  out.cell_m = message.cell_m;
  out.origin_x_m = message.origin_x_m;
  out.origin_y_m = message.origin_y_m;
  out.cells_x = message.cells_x;
  out.cells_y = message.cells_y;
  out.cells = message.cells;
  return out;
}

}  // namespace

PoseSample pose_from(const pose_t& message, double origin_height_m) {
  PoseSample out;
  out.utime = message.header.utime;
  out.T_odom_ground =
      ground_pose(rover::pose_from(message.position_odom_body_m, message.quat_odom_body_wxyz), origin_height_m);
  out.T_map_odom = rover::pose_from(message.position_map_odom_m, message.quat_map_odom_wxyz);
  out.forward_mps = message.velocity_body_mps[0];
  out.left_mps = message.velocity_body_mps[1];
  out.yaw_rate_radps = message.rate_body_radps[2];
  const bool numbers = is_finite(out.T_odom_ground) && is_finite(out.T_map_odom) && std::isfinite(out.forward_mps) &&
                       std::isfinite(out.left_mps) && std::isfinite(out.yaw_rate_radps);
  out.usable = numbers && (message.status == pose_t::OK || message.status == pose_t::DEGRADED);
  out.new_odom = message.status == pose_t::UNINITIALISED;
  return out;
}

HazardGrid hazards_from(const hazards_t& message) {
  return grid_from<HazardGrid>(message);
}

TraversabilityGrid traversability_from(const traversability_t& message) {
  auto out = grid_from<TraversabilityGrid>(message);
  out.step_percent = message.step_percent;
  out.height_m = message.height_m;
  return out;
}

std::string global_path_from(const path_t& message, GlobalPath& path) {
  if (message.frame != path_t::MAP) return "path is not in the map frame";
  const size_t count = message.x_m.size();
  if (message.y_m.size() != count || message.level.size() != count || message.direction.size() != count)
    return "path has lists of different lengths";
  path.id = message.path_id;
  path.corridor_half_width_m = message.corridor_half_width_m;
  path.goal_tolerance_m = message.goal_tolerance_m;
  path.zones = zones_from(message);
  path.points.clear();
  for (size_t i = 0; i < count; ++i) {
    if (message.level[i] != path_t::EFFICIENT && message.level[i] != path_t::FULL)
      return "point " + std::to_string(i) + " of the path has an unknown level";
    if (message.direction[i] != path_t::FORWARD)
      return "point " + std::to_string(i) + " of the path is not driven forward";
    path.points.push_back({{message.x_m[i], message.y_m[i]}, kNaN, message.level[i]});
  }
  return path.fault();
}

void path_to(const LocalPath& path, path_t& message) {
  message.path_id = path.id;
  message.frame = path_t::ODOM;
  message.kind = static_cast<std::int8_t>(path.kind);
  message.corridor_half_width_m = path.corridor_half_width_m;
  message.goal_tolerance_m = path.goal_tolerance_m;
  zones_to(path.zones, message);
  message.point_count = static_cast<std::int32_t>(path.points.size());
  for (const RoutePoint& point : path.points) {
    message.x_m.push_back(point.p.x_m);
    message.y_m.push_back(point.p.y_m);
    message.level.push_back(point.level);
    message.direction.push_back(point.reverse ? std::int8_t{path_t::REVERSE} : std::int8_t{path_t::FORWARD});
  }
}

void status_to(const PlannerStatus& status, planner_status_t& message) {
  message.state = static_cast<std::int8_t>(status.state);
  message.path_id = status.path_id;
  message.global_path_id = status.global_path_id;
  message.blocked_in_m = status.blocked_in_m;
  message.block_kind = static_cast<std::int8_t>(status.block_kind);
  message.replans = status.replans;
  message.goal_distance_m = status.goal_distance_m;
  message.corridor_offset_m = status.corridor_offset_m;
  message.text = status.text;
}

}  // namespace rover::planning
