// Path-following steering law in Frenet coordinates (C. Samson, "Control of chained systems", 1995).
// For small errors e'' = k - k_path (derivatives along the path), so with cross track e, heading error h, damping z
//   k = k_path cos(h) / (1 - k_path e) - 2 z/L h - e/L^2 - i
// the error decays within the length L at any speed. The integral i removes the steady drift on a side slope.
// Not used: conservative pursuit (Filip 2017), which cuts corners and has no curvature feedforward.
#pragma once

namespace rover::control {

struct SteeringLawConfig {
  double length_m = 0.7;  // L: decay length of the error
  double damping = 1.0;
  double integral_per_m3 = 0.3;      // gain on cross track per distance: settles within about 5 m
  double max_integral_per_m = 0.35;  // limit of i
  double max_integrated_m = 0.05;    // cross track is clamped to this before integration
  double max_cross_track_m = 0.5;    // clamp of e: larger errors are approached at the same angle, 20 deg
  double max_curvature_per_m = 1.0;
};

struct TrackError {
  double cross_track_m = 0.0;  // positive: left of the path
  double heading_rad = 0.0;    // direction of motion minus path heading
};

double steering_law(const SteeringLawConfig& config, double path_curvature_per_m, const TrackError& error,
                    double integral_per_m);

}  // namespace rover::control
