// Orbital map: box-filtered and smoothed fine surface with correlated vertical noise and a zero-mean horizontal
// distortion.
#include <algorithm>
#include <cmath>

#include "rover_simulator/world/noise.hpp"
#include "rover_simulator/world/world.hpp"

namespace rover {
namespace {

constexpr double kBoxStepM = 0.25;  // sample spacing of the box filter

double box_mean(const Surface& surface, double x0_m, double y0_m, double side_m) {
  const int n = std::max(1, static_cast<int>(std::lround(side_m / kBoxStepM)));
  double sum = 0.0;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) sum += surface.height_m(x0_m + (i + 0.5) * side_m / n, y0_m + (j + 0.5) * side_m / n);
  return sum / (n * n);
}

}  // namespace

ElevationRaster World::orbital_frame(double resolution_m) const {
  ElevationRaster frame;
  frame.width = static_cast<int>(std::floor(width_m() / resolution_m));
  frame.height = static_cast<int>(std::floor(length_m() / resolution_m));
  frame.resolution_m = resolution_m;
  frame.west_m = dtm_.west_m;
  frame.south_m = dtm_.south_m;
  frame.projection_wkt = dtm_.projection_wkt;
  frame.z_m.resize(static_cast<size_t>(frame.width) * frame.height);
  return frame;
}

OrbitalShift World::shift_in(const ElevationRaster& frame) const {
  return orbital_shift(config_.orbital, frame, orbital_seed());
}

ElevationRaster World::orbital_map(double resolution_m) const {
  const OrbitalConfig& config = config_.orbital;
  ElevationRaster map = orbital_frame(resolution_m);
  const OrbitalShift shift = shift_in(map);
  for (int row = 0; row < map.height; ++row)
    for (int column = 0; column < map.width; ++column) {
      const size_t i = static_cast<size_t>(row) * map.width + column;
      map.z_m[i] = static_cast<float>(
          box_mean(*this, column * resolution_m + shift.x_m[i], row * resolution_m + shift.y_m[i], resolution_m));
    }
  blur(map, config.smoothing_px);
  const std::vector<double> noise = noise_field(map.width, map.height, config.noise_correlation_px * 1.5,
                                                config.vertical_noise_m, orbital_seed() + 2);
  for (size_t i = 0; i < noise.size(); ++i) map.z_m[i] += static_cast<float>(noise[i]);
  return map;
}

}  // namespace rover
