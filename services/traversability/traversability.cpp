#include "traversability/traversability.hpp"

#include <algorithm>
#include <cmath>

#include "traversability/obstacles.hpp"
#include "traversability/small_holes.hpp"

namespace rover::trav {
namespace {

constexpr double kDearest = 253.0;

std::vector<std::uint8_t> seen_cells(const TerrainGrid& grid) {
  std::vector<std::uint8_t> seen(grid.shape.size());
  std::transform(grid.height_m.begin(), grid.height_m.end(), seen.begin(), [](float z) { return !std::isnan(z); });
  return seen;
}

// Of one cell that was seen and is no obstacle.
class CellJudge {
 public:
  explicit CellJudge(const TraversabilityConfig& config) : config_(config) {}

  std::uint8_t cost(const DiscPlane& plane, float height_m, float sigma_m, float rise_m) const {
    if (std::isnan(plane.slope_x)) return kUnknown;
    const double slope_rad = std::atan(std::hypot(plane.slope_x, plane.slope_y));
    if (slope_rad > config_.cost.max_slope_rad) return kImpassable;
    if (height_m - plane.height_m >= config_.belly_limit_m()) return kImpassable;
    const double rough_m = std::sqrt(std::max(0.0F, plane.rms_m * plane.rms_m - sigma_m * sigma_m));
    const CostConfig& c = config_.cost;
    const double share = std::pow(slope_rad / c.max_slope_rad, c.slope_exponent) +
                         std::pow(rise_m / config_.step_limit_m(), c.step_exponent) +
                         std::pow(rough_m / c.rough_m, c.rough_exponent);
    return static_cast<std::uint8_t>(std::lround(kDearest * std::min(share, 1.0)));
  }

 private:
  const TraversabilityConfig& config_;
};

// What a grid shows beside each other: the obstacles, and the ground between them.
struct Ground {
  std::vector<std::uint8_t> seen;
  std::vector<std::uint8_t> obstacle;
  Steps steps;
  DiscPlanes planes;

  Ground(const TerrainGrid& grid, const TraversabilityConfig& config)
      : seen(seen_cells(grid)), planes(grid.shape, config.plane) {
    planes.fit(grid.height_m, seen);
    find(grid, config);
    // Again, with slopes that large rocks do not tilt.
    std::vector<std::uint8_t> between(seen);
    for (std::size_t i = 0; i < between.size(); ++i) between[i] = seen[i] && !obstacle[i];
    planes.fit_again(grid.height_m, between);
    find(grid, config);
  }

 private:
  void find(const TerrainGrid& grid, const TraversabilityConfig& config) {
    steps = find_steps(grid, planes, config.step);
    obstacle = find_obstacles(grid, planes, steps, config);
    close_islands(grid, config.footprint_m2, obstacle);
  }
};

}  // namespace

TraversabilityMap judge_terrain(TerrainGrid grid, const TraversabilityConfig& config) {
  close_small_holes(grid, config.step.max_sigma_m, config.step.foot_m);
  Ground ground(grid, config);
  TraversabilityMap map{grid.shape, std::vector<std::uint8_t>(grid.shape.size(), kUnknown), {}};
  const CellJudge judge(config);
  for (std::size_t i = 0; i < map.cells.size(); ++i) {
    if (!ground.seen[i]) continue;
    if (ground.obstacle[i])
      map.cells[i] = kImpassable;
    else if (ground.steps.uncertain_rise_m[i] < config.step_limit_m())
      map.cells[i] = judge.cost(ground.planes.at(i), grid.height_m[i], grid.sigma_m[i], ground.steps.rise_m[i]);
  }
  map.obstacle = std::move(ground.obstacle);
  return map;
}

}  // namespace rover::trav
