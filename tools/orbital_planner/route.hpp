// Path from a cost map: fast marching from the goal, gradient descent on the cost-to-go, resampling, smoothing.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "common/core/fast_marching.hpp"

namespace rover::orbital {

using Line = std::vector<Eigen::Vector2d>;  // map coordinates [m]

struct RouteConfig {
  double point_spacing_m = 1.5;
  double smoothing_sigma_m = 3.0;  // along the line
};

// Cell index of a map point, -1 outside.
int cell_at(const MarchGrid& grid, const Eigen::Vector2d& p);
// Infinity outside.
double cost_at(const MarchGrid& grid, const Eigen::Vector2d& p);
// True if all cells on the straight segment are traversable.
bool is_open(const MarchGrid& grid, const Eigen::Vector2d& a, const Eigen::Vector2d& b);

// Minimum-cost path; empty if the goal is unreachable. Both points must be in traversable cells.
std::optional<Line> minimum_cost_path(const MarchGrid& grid, const Eigen::Vector2d& start, const Eigen::Vector2d& goal);

double length_m(std::span<const Eigen::Vector2d> line);
// Equidistant points; keeps both ends. Where the chord between two points is blocked, keeps the line's own vertices.
Line resampled(const Line& line, double spacing_m, const MarchGrid& grid);
// Laplacian smoothing with fixed ends; a point stays if the line would cross a cell that is not traversable.
Line smoothed(Line line, const MarchGrid& grid, const RouteConfig& config);

}  // namespace rover::orbital
