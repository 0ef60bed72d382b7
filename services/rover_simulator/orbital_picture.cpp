#include "rover_simulator/orbital_picture.hpp"

#include <algorithm>
#include <cmath>

#include "rover_simulator/camera/counter_hash.hpp"
#include "rover_simulator/camera/ground_picture.hpp"

namespace rover {
namespace {

constexpr double kMeanGrey = 100.0;

double box_mean(const ElevationRaster& ground, double x0_m, double y0_m, double side_m) {
  const int n = std::max(1, static_cast<int>(std::lround(side_m / ground.resolution_m)));
  double sum = 0.0;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int column = static_cast<int>((x0_m + (i + 0.5) * side_m / n) / ground.resolution_m);
      const int row = static_cast<int>((y0_m + (j + 0.5) * side_m / n) / ground.resolution_m);
      sum += ground.at(std::clamp(column, 0, ground.width - 1), std::clamp(row, 0, ground.height - 1));
    }
  return sum / (n * n);
}

void digitise(ElevationRaster& picture, double noise, std::uint64_t seed) {
  double mean = 0.0;
  for (const float value : picture.z_m) mean += value / static_cast<double>(picture.z_m.size());
  for (size_t i = 0; i < picture.z_m.size(); ++i) {
    // Sum of three uniform numbers: close to normal, variance 1/4.
    double sum = -1.5;
    for (std::uint64_t k = 0; k < 3; ++k) sum += unit_random(hash64(hash64(seed, i), k));
    const double grey = kMeanGrey * (picture.z_m[i] / mean + 2.0 * noise * sum);
    picture.z_m[i] = static_cast<float>(std::clamp(std::round(grey), 0.0, 255.0));
  }
}

}  // namespace

ElevationRaster orbital_picture(const World& world, const OrbitalPictureConfig& config, GroundAppearanceConfig ground,
                                int threads) {
  ground.sun_elevation_rad = config.sun_elevation_rad;
  ground.sun_azimuth_rad = config.sun_azimuth_rad;
  const ElevationRaster seen = ground_picture(world, ground, world.width_m(), world.length_m(), threads);
  ElevationRaster picture = world.orbital_frame(config.resolution_m);
  const OrbitalShift shift = world.shift_in(picture);
  for (int row = 0; row < picture.height; ++row)
    for (int column = 0; column < picture.width; ++column) {
      const size_t i = static_cast<size_t>(row) * picture.width + column;
      picture.z_m[i] = static_cast<float>(box_mean(seen, column * config.resolution_m + shift.x_m[i],
                                                   row * config.resolution_m + shift.y_m[i], config.resolution_m));
    }
  blur(picture, world.orbital().smoothing_px);
  digitise(picture, config.noise, hash64(ground.seed, 77));
  return picture;
}

}  // namespace rover
