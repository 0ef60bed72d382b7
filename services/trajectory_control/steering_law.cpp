#include "trajectory_control/steering_law.hpp"

#include <algorithm>
#include <cmath>

namespace rover::control {

double steering_law(const SteeringLawConfig& config, double path_curvature_per_m, const TrackError& error,
                    double integral_per_m) {
  const double e = std::clamp(error.cross_track_m, -config.max_cross_track_m, config.max_cross_track_m);
  // On the inner side of a bend the parallel curve is tighter; limited to twice the path curvature.
  const double parallel = std::max(1.0 - path_curvature_per_m * e, 0.5);
  const double forward = path_curvature_per_m * std::cos(error.heading_rad) / parallel;
  const double feedback =
      2.0 * config.damping / config.length_m * error.heading_rad + e / (config.length_m * config.length_m);
  return std::clamp(forward - feedback - integral_per_m, -config.max_curvature_per_m, config.max_curvature_per_m);
}

}  // namespace rover::control
