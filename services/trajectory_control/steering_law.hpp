// The curvature that leads back to a path: what the path asks for, plus feedback on the errors.
//
// In Frenet coordinates and small errors the cross track e obeys e'' = k - k_path (primes along the way), so with
//   k = k_path cos(h) / (1 - k_path e) - 2 z/L h - e/L^2 - i
// it returns within the length L with damping z, at any speed (C. Samson, "Control of chained systems", 1995). The
// integral i takes the steady drift on a side slope. Conservative pursuit (Filip 2017) steers to a point ahead instead,
// which cuts corners by design and knows no curvature of the path.
#pragma once

namespace rover::control {

struct SteeringLawConfig {
  double length_m = 0.7;  // of the return to the path
  double damping = 1.0;
  double integral_per_m3 = 0.3;      // of cross track over the way: settles within about 5 m
  double max_integral_per_m = 0.35;  // of the curvature it may add
  double max_integrated_m = 0.05;    // of cross track
  double max_cross_track_m = 0.5;    // errors beyond are approached under the same angle, 20 deg
  double max_curvature_per_m = 1.0;
};

struct TrackError {
  double cross_track_m = 0.0;  // positive: left of the path
  double heading_rad = 0.0;    // of the rover's motion minus the path's
};

double curvature_to(const SteeringLawConfig& config, double path_curvature_per_m, const TrackError& error,
                    double integral_per_m);

}  // namespace rover::control
