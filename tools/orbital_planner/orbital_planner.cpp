#include "tools/orbital_planner/orbital_planner.hpp"

#include <algorithm>
#include <cmath>

#include "common/core/check.hpp"

namespace rover::orbital {
namespace {

PlanStatus check_waypoint(const TerrainLayers& terrain, const CostMap& costs, const Eigen::Vector2d& p) {
  const int cell = cell_at(costs.grid, p);
  if (cell < 0) return PlanStatus::kOutside;
  if (terrain.terrain_class[cell] == TerrainClass::kUnknown) return PlanStatus::kNoData;
  return std::isinf(costs.grid.cost_per_m[cell]) ? PlanStatus::kNotClear : PlanStatus::kPlanned;
}

bool check_waypoints(const Line& waypoints, const CostMap& costs, Plan& plan) {
  for (size_t i = 0; i < waypoints.size(); ++i) {
    plan.status = check_waypoint(plan.terrain, costs, waypoints[i]);
    plan.waypoint = i;
    const bool on_map = plan.status == PlanStatus::kPlanned || plan.status == PlanStatus::kNotClear;
    if (on_map && forbidding_zone(plan.zones, waypoints[i])) plan.status = PlanStatus::kForbidden;
    if (plan.status == PlanStatus::kNotClear)
      plan.obstacle_distance_m = costs.obstacle_distance_m[cell_at(costs.grid, waypoints[i])];
    if (plan.status != PlanStatus::kPlanned) return false;
  }
  return true;
}

bool connect_waypoints(const Line& waypoints, const MarchGrid& grid, Plan& plan) {
  plan.line = {waypoints.front()};
  for (size_t i = 1; i < waypoints.size(); ++i) {
    const std::optional<Line> segment = minimum_cost_path(grid, waypoints[i - 1], waypoints[i]);
    if (!segment) {
      plan.status = PlanStatus::kUnreachable;
      plan.waypoint = i;
      return false;
    }
    plan.line.insert(plan.line.end(), segment->begin() + 1, segment->end());
  }
  return true;
}

// Smoothing moves points together in bends: resample.
Line drivable(const Line& line, const MarchGrid& grid, const RouteConfig& config) {
  const double spacing = config.point_spacing_m;
  return resampled(smoothed(resampled(line, spacing, grid), grid, config), spacing, grid);
}

double slope_at(const TerrainLayers& terrain, const MarchGrid& grid, const Eigen::Vector2d& p) {
  return terrain.slope_rad[cell_at(grid, p)];
}

PathSegment make_segment(const Plan& plan, const MarchGrid& grid, size_t first, size_t last) {
  PathSegment s{first, last, plan.level[first]};
  s.length_m = length_m(std::span(plan.line).subspan(first, last - first + 1));
  for (size_t i = first; i <= last; ++i) {
    s.mean_difficulty += plan.difficulty[i] / static_cast<double>(last - first + 1);
    s.max_slope_rad = std::max(s.max_slope_rad, slope_at(plan.terrain, grid, plan.line[i]));
  }
  return s;
}

void measure(const MarchGrid& grid, Plan& plan) {
  size_t first = 0;
  for (size_t i = 1; i < plan.line.size(); ++i) {
    const bool ends = i + 1 == plan.line.size() || plan.level[i] != plan.level[first];
    if (!ends) continue;
    plan.segments.push_back(make_segment(plan, grid, first, i));
    first = i;
  }
  plan.length_m = length_m(plan.line);
  for (size_t i = 1; i < plan.line.size(); ++i)
    plan.cost_m += (plan.line[i] - plan.line[i - 1]).norm() * cost_at(grid, 0.5 * (plan.line[i] + plan.line[i - 1]));
}

}  // namespace

Plan plan(TerrainLayers terrain, const Line& waypoints, const PlannerConfig& config, const std::vector<Zone>& zones) {
  ROVER_CHECK(waypoints.size() >= 2, waypoints.size());
  Plan plan;
  plan.zones = zones;
  plan.terrain = std::move(terrain);
  const CostMap costs = travel_cost(plan.terrain, config.cost, zones);
  if (!check_waypoints(waypoints, costs, plan) || !connect_waypoints(waypoints, costs.grid, plan)) return plan;
  plan.line = drivable(plan.line, costs.grid, config.route);
  plan.difficulty = difficulty_along(plan.line, plan.terrain, config.levels);
  plan.level = levels_along(plan.line, plan.difficulty, config.levels);
  measure(costs.grid, plan);
  return plan;
}

}  // namespace rover::orbital
