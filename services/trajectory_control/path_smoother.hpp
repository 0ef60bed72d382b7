// Penalised smoothing spline (Reinsch, "Smoothing by spline functions", 1967) with iteratively increased weights.
// The penalty is the third derivative (change of curvature, which costs steering motion). Weights grow where the curve
// is farther from the polyline than max_distance_m.
#pragma once

#include <Eigen/Dense>
#include <vector>

namespace rover::control {

struct SmootherConfig {
  double length_m = 1.0;         // features shorter than this are smoothed away if the distance allows
  double max_distance_m = 0.05;  // from the polyline; exceeded by a few percent at most
  int iterations = 12;
};

// `points` are equally spaced by step_m. Returns as many points, with first and last unchanged.
std::vector<Eigen::Vector2d> smooth(const std::vector<Eigen::Vector2d>& points, double step_m,
                                    const SmootherConfig& config);

}  // namespace rover::control
