// The smoothest curve near a polyline: least squares of the third derivative (the change of curvature, that is the
// work of the steering motors) against the distance to the polyline, which weights bound to a given largest.
//
// A penalized smoothing spline (Reinsch, "Smoothing by spline functions", 1967) with iterated weights: they grow
// wherever the curve is farther away than allowed, so it leaves the polyline where that spares steering, and only
// there.
#pragma once

#include <Eigen/Dense>
#include <vector>

namespace rover::control {

struct SmootherConfig {
  double length_m = 1.0;         // of features that are smoothed away where the distance allows it
  double max_distance_m = 0.05;  // from the polyline, but for a few percent
  int iterations = 12;
};

// `points` at equal steps; as many come back, the first and last in place.
std::vector<Eigen::Vector2d> smooth(const std::vector<Eigen::Vector2d>& points, double step_m,
                                    const SmootherConfig& config);

}  // namespace rover::control
