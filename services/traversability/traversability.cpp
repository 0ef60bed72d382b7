#include "traversability/traversability.hpp"

#include <algorithm>
#include <cmath>

#include "traversability/hole_filling.hpp"
#include "traversability/obstacles.hpp"

namespace rover::trav {
namespace {

constexpr double kMaxCost = 252.0;

std::vector<std::uint8_t> seen_cells(const TerrainGrid& grid) {
  std::vector<std::uint8_t> seen(grid.shape.size());
  std::transform(grid.height_m.begin(), grid.height_m.end(), seen.begin(), [](float z) { return !std::isnan(z); });
  return seen;
}

// Cost of a seen, obstacle-free cell.
class CellCost {
 public:
  explicit CellCost(const TraversabilityConfig& config) : config_(config) {}

  std::uint8_t cost(const DiscPlane& plane, float height_m, float sigma_m, float rise_m) const {
    if (std::isnan(plane.slope_x)) return kUnknown;
    const double slope_rad = std::atan(std::hypot(plane.slope_x, plane.slope_y));
    if (slope_rad > config_.cost.max_slope_rad) return kImpassable;
    if (height_m - plane.height_m >= config_.belly_limit_m()) return kImpassable;
    const double roughness_m = std::sqrt(std::max(0.0F, plane.rms_m * plane.rms_m - sigma_m * sigma_m));
    const CostConfig& c = config_.cost;
    const double share = std::pow(slope_rad / c.max_slope_rad, c.slope_exponent) +
                         std::pow(rise_m / config_.step_limit_m(), c.step_exponent) +
                         std::pow(roughness_m / c.max_roughness_m, c.roughness_exponent);
    return static_cast<std::uint8_t>(std::lround(kMaxCost * std::min(share, 1.0)));
  }

 private:
  const TraversabilityConfig& config_;
};

// Obstacles, and planes and steps of the ground between them.
struct TerrainAnalysis {
  std::vector<std::uint8_t> seen;
  std::vector<std::uint8_t> obstacle;
  std::vector<std::uint8_t> low;  // of them
  Steps steps;
  DiscPlanes planes;

  TerrainAnalysis(const TerrainGrid& grid, const TraversabilityConfig& config)
      : seen(seen_cells(grid)), planes(grid.shape, config.plane) {
    planes.fit(grid.height_m, seen);
    detect(grid, config);
    // Second pass without the obstacles, which tilt the planes beside them.
    std::vector<std::uint8_t> without_obstacles(seen);
    for (std::size_t i = 0; i < without_obstacles.size(); ++i) without_obstacles[i] = seen[i] && !obstacle[i];
    planes.refit(grid.height_m, without_obstacles);
    detect(grid, config);
    low = find_low_obstacles(grid, planes, steps, obstacle, config);
  }

 private:
  void detect(const TerrainGrid& grid, const TraversabilityConfig& config) {
    steps = find_steps(grid, planes, config.step);
    obstacle = find_obstacles(grid, planes, steps, config);
    fill_enclosed_regions(grid, config.footprint_m2, obstacle);
  }
};

}  // namespace

TraversabilityMap compute_traversability(TerrainGrid grid, const TraversabilityConfig& config) {
  fill_small_holes(grid, config.step.max_sigma_m, config.step.grow_height_m);
  TerrainAnalysis analysis(grid, config);
  TraversabilityMap map{grid.shape, std::vector<std::uint8_t>(grid.shape.size(), kUnknown), {}, {}, {}};
  const CellCost cell_cost(config);
  for (std::size_t i = 0; i < map.cells.size(); ++i) {
    if (!analysis.seen[i]) continue;
    if (analysis.obstacle[i])
      map.cells[i] = analysis.low[i] ? kLow : kImpassable;
    else if (analysis.steps.raw_rise_m[i] < config.step_limit_m())
      map.cells[i] = cell_cost.cost(analysis.planes.at(i), grid.height_m[i], grid.sigma_m[i], analysis.steps.rise_m[i]);
  }
  for (const float rise_m : analysis.steps.rise_m)
    map.step_percent.push_back(static_cast<std::uint8_t>(std::min(255.0, 100.0 * rise_m / config.step_limit_m())));
  map.obstacle = std::move(analysis.obstacle);
  map.height_m = std::move(grid.height_m);
  return map;
}

}  // namespace rover::trav
