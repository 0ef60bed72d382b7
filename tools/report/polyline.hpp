// Planar polylines.
#pragma once

#include <Eigen/Dense>
#include <vector>

namespace rover::report {

using Points = std::vector<Eigen::Vector2d>;

double length_m(const Points& line);
// Infinity for an empty line.
double distance_m(const Points& line, const Eigen::Vector2d& p);
// The part that starts at the point closest to p, at most ahead_m long.
Points part_ahead(const Points& line, const Eigen::Vector2d& p, double ahead_m);

// Distance from a point to an axis-aligned rectangle centred at the origin; 0 inside.
double distance_to_box_m(const Eigen::Vector2d& p_box, double half_length_m, double half_width_m);

}  // namespace rover::report
