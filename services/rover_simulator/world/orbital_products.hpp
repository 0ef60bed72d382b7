// The map and the picture that an orbiter made of the world: what they show, and their errors.
#pragma once

#include <cstdint>
#include <vector>

#include "common/core/frames.hpp"
#include "common/geo/elevation_raster.hpp"

namespace rover {

// Errors of the orbital map relative to the world.
struct OrbitalConfig {
  double smoothing_px = 0.7;      // Gaussian, standard deviation
  double vertical_noise_m = 0.1;  // rms
  double noise_correlation_px = 2.0;
  double distortion_m = 0.3;  // rms, horizontal, per axis
  double distortion_wave_m = 60.0;
};

struct OrbitalPictureConfig {
  double resolution_m = 0.25;
  double sun_elevation_rad = to_rad(50.0);
  double sun_azimuth_rad = to_rad(-20.0);  // towards the sun, counter-clockwise from map x
  double noise = 0.01;                     // of a pixel, relative to the picture's mean
};

// Correlated noise with zero mean, row by row.
std::vector<double> noise_field(int width, int height, double wave_px, double rms, std::uint64_t seed);

// What pixel i shows is displaced by (x_m[i], y_m[i]): a field of `distortion_m` about zero.
struct OrbitalShift {
  std::vector<double> x_m, y_m;
};
OrbitalShift orbital_shift(const OrbitalConfig& config, const ElevationRaster& frame, std::uint64_t seed);

// Gaussian, with replicated border.
void blur(ElevationRaster& raster, double sigma_px);

}  // namespace rover
