// From travel costs to a line that can be driven: fast marching from the goal (the globally best way on the cost map),
// descent along the steepest fall of the travel cost, points at even distances, corners rounded.
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
  double rounding_m = 3.0;  // standard deviation of the smoothing along the line
};

// Cell under a place of the map, -1 outside.
int cell_at(const MarchGrid& grid, const Eigen::Vector2d& p);
// Infinity outside.
double cost_at(const MarchGrid& grid, const Eigen::Vector2d& p);
// Whether the straight way keeps to cells that may be entered.
bool is_open(const MarchGrid& grid, const Eigen::Vector2d& a, const Eigen::Vector2d& b);

// The best way between two places; none where the goal cannot be reached. Both must lie on cells that may be entered.
std::optional<Line> best_way(const MarchGrid& grid, const Eigen::Vector2d& start, const Eigen::Vector2d& goal);

double length_m(std::span<const Eigen::Vector2d> line);
// Points at even distances of about the spacing, first and last kept; where the straight way between two of them is not
// open, the line's own points as well.
Line resampled(const Line& line, double spacing_m, const MarchGrid& grid);
// Points drawn towards the middle of their neighbours again and again, the ends fixed; a point stays where the line
// would cross a cell that may not be entered.
Line rounded(Line line, const MarchGrid& grid, const RouteConfig& config);

}  // namespace rover::orbital
