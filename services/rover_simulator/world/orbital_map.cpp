// Orbital map: box-filtered and smoothed fine surface with correlated vertical noise and a zero-mean horizontal
// distortion.
#include <algorithm>
#include <cmath>

#include "rover_simulator/world/noise.hpp"
#include "rover_simulator/world/world.hpp"

namespace rover {
namespace {

constexpr double kBoxStepM = 0.25;  // sample spacing of the box filter

using Field = std::vector<double>;

void subtract_mean(Field& field) {
  double mean = 0.0;
  for (double v : field) mean += v / static_cast<double>(field.size());
  for (double& v : field) v -= mean;
}

Field noise_field(int width, int height, double wave_px, double rms, std::uint64_t seed) {
  Field field;
  field.reserve(static_cast<size_t>(width) * height);
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column)
      field.push_back(rms * gradient_noise(seed, column / wave_px, row / wave_px));
  subtract_mean(field);
  return field;
}

std::vector<double> gaussian_kernel(double sigma_px) {
  const int reach = static_cast<int>(std::ceil(3.0 * sigma_px));
  std::vector<double> kernel;
  double sum = 0.0;
  for (int i = -reach; i <= reach; ++i) {
    kernel.push_back(sigma_px > 0.0 ? std::exp(-0.5 * i * i / (sigma_px * sigma_px)) : 1.0);
    sum += kernel.back();
  }
  for (double& k : kernel) k /= sum;
  return kernel;
}

// One pass of the separable filter, along columns or rows, with replicated border.
void smooth_along(ElevationRaster& raster, const std::vector<double>& kernel, bool columns) {
  const ElevationRaster source = raster;
  const int reach = static_cast<int>(kernel.size() / 2);
  for (int row = 0; row < raster.height; ++row)
    for (int column = 0; column < raster.width; ++column) {
      double sum = 0.0;
      for (int i = -reach; i <= reach; ++i) {
        const int c = columns ? std::clamp(column + i, 0, raster.width - 1) : column;
        const int r = columns ? row : std::clamp(row + i, 0, raster.height - 1);
        sum += kernel[i + reach] * source.at(c, r);
      }
      raster.at(column, row) = static_cast<float>(sum);
    }
}

double box_mean(const Surface& surface, double x0_m, double y0_m, double side_m) {
  const int n = std::max(1, static_cast<int>(std::lround(side_m / kBoxStepM)));
  double sum = 0.0;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) sum += surface.height_m(x0_m + (i + 0.5) * side_m / n, y0_m + (j + 0.5) * side_m / n);
  return sum / (n * n);
}

}  // namespace

ElevationRaster World::orbital_map(double resolution_m) const {
  const OrbitalConfig& config = config_.orbital;
  ElevationRaster map;
  map.width = static_cast<int>(std::floor(width_m() / resolution_m));
  map.height = static_cast<int>(std::floor(length_m() / resolution_m));
  map.resolution_m = resolution_m;
  map.west_m = dtm_.west_m;
  map.south_m = dtm_.south_m;
  map.projection_wkt = dtm_.projection_wkt;
  map.z_m.resize(static_cast<size_t>(map.width) * map.height);
  const std::uint64_t seed = hash_cell(seed_, 77, 0);
  const double wave_px = config.distortion_wave_m / resolution_m;
  const Field dx = noise_field(map.width, map.height, wave_px, config.distortion_m, seed);
  const Field dy = noise_field(map.width, map.height, wave_px, config.distortion_m, seed + 1);
  for (int row = 0; row < map.height; ++row)
    for (int column = 0; column < map.width; ++column) {
      const size_t i = static_cast<size_t>(row) * map.width + column;
      map.z_m[i] =
          static_cast<float>(box_mean(*this, column * resolution_m + dx[i], row * resolution_m + dy[i], resolution_m));
    }
  const std::vector<double> kernel = gaussian_kernel(config.smoothing_px);
  smooth_along(map, kernel, true);
  smooth_along(map, kernel, false);
  const Field noise =
      noise_field(map.width, map.height, config.noise_correlation_px * 1.5, config.vertical_noise_m, seed + 2);
  for (size_t i = 0; i < noise.size(); ++i) map.z_m[i] += static_cast<float>(noise[i]);
  return map;
}

}  // namespace rover
