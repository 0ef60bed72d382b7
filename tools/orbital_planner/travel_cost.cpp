#include "tools/orbital_planner/travel_cost.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/core/distance_field.hpp"

namespace rover::orbital {
namespace {

constexpr double kMaxSteps = 1e6;

// The cells that the sides of a keep-out pass: it may lie between the centres of cells.
void close_border(const Zone& zone, const TerrainLayers& layers, std::vector<std::uint8_t>& closed) {
  if (zone.keep_in) return;
  for (size_t i = 0; i < zone.points.size(); ++i) {
    const Eigen::Vector2d a = zone.points[i], b = zone.points[(i + 1) % zone.points.size()];
    const int steps = 1 + static_cast<int>(std::min((b - a).norm() / (0.5 * layers.cell_m), kMaxSteps));
    for (int k = 0; k < steps; ++k) {
      const Eigen::Vector2d cell = (a + static_cast<double>(k) / steps * (b - a)) / layers.cell_m;
      if (cell.minCoeff() >= 0.0 && cell.x() < layers.width && cell.y() < layers.height)
        closed[static_cast<size_t>(cell.y()) * static_cast<size_t>(layers.width) + static_cast<size_t>(cell.x())] = 1;
    }
  }
}

// Distance to obstacles, forbidden and unknown ground; outside of the map is unknown.
std::vector<double> distance_to_closed(const TerrainLayers& layers, const std::vector<Zone>& zones) {
  std::vector<std::uint8_t> closed(layers.terrain_class.size());
  std::transform(layers.terrain_class.begin(), layers.terrain_class.end(), closed.begin(), [](TerrainClass c) {
    return static_cast<std::uint8_t>(c == TerrainClass::kUnknown || c == TerrainClass::kObstacle);
  });
  for (size_t i = 0; !zones.empty() && i < closed.size(); ++i) {
    const auto x = static_cast<double>(i % static_cast<size_t>(layers.width));
    const auto y = static_cast<double>(i / static_cast<size_t>(layers.width));
    if (forbidding_zone(zones, layers.cell_m * Eigen::Vector2d(x + 0.5, y + 0.5))) closed[i] = 1;
  }
  for (const Zone& zone : zones) close_border(zone, layers, closed);
  std::vector<double> distance = distance_field(closed, layers.width, layers.height, layers.cell_m);
  for (int y = 0; y < layers.height; ++y)
    for (int x = 0; x < layers.width; ++x) {
      const int cells = 1 + std::min({x, y, layers.width - 1 - x, layers.height - 1 - y});
      double& d = distance[static_cast<size_t>(y) * layers.width + x];
      d = std::min(d, cells * layers.cell_m);
    }
  return distance;
}

double risk_factor(double distance_m, const CostConfig& config) {
  if (distance_m >= config.risk_distance_m) return 0.0;
  return config.risk_cost * (config.risk_distance_m - distance_m) / (config.risk_distance_m - config.clearance_m);
}

}  // namespace

double slope_cost(double slope_rad) {
  static constexpr std::array<double, 4> kCost = {1.0, 1.5, 2.5, 4.0};
  constexpr double kStepRad = to_rad(5.0);
  const double position = slope_rad / kStepRad;
  // Linear extrapolation beyond the table's end, if the configuration allows steeper ground.
  const size_t i = std::min(static_cast<size_t>(position), kCost.size() - 2);
  return kCost[i] + (position - static_cast<double>(i)) * (kCost[i + 1] - kCost[i]);
}

CostMap travel_cost(const TerrainLayers& layers, const CostConfig& config, const std::vector<Zone>& zones) {
  CostMap map{{layers.width, layers.height, layers.cell_m, {}}, distance_to_closed(layers, zones)};
  map.grid.cost_per_m.assign(layers.terrain_class.size(), kInfinity);
  for (size_t i = 0; i < layers.terrain_class.size(); ++i) {
    const double distance = map.obstacle_distance_m[i];
    if (distance == 0.0 || distance < config.clearance_m) continue;
    map.grid.cost_per_m[i] = slope_cost(layers.slope_rad[i]) * (1.0 + risk_factor(distance, config)) +
                             config.difficulty_cost * layers.difficulty[i];
  }
  return map;
}

}  // namespace rover::orbital
