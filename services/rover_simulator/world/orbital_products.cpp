#include "rover_simulator/world/orbital_products.hpp"

#include <algorithm>
#include <cmath>

#include "rover_simulator/world/noise.hpp"

namespace rover {
namespace {

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

// One pass of the separable filter, along columns or rows.
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

}  // namespace

std::vector<double> noise_field(int width, int height, double wave_px, double rms, std::uint64_t seed) {
  std::vector<double> field;
  field.reserve(static_cast<size_t>(width) * height);
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column)
      field.push_back(rms * gradient_noise(seed, column / wave_px, row / wave_px));
  double mean = 0.0;
  for (double v : field) mean += v / static_cast<double>(field.size());
  for (double& v : field) v -= mean;
  return field;
}

OrbitalShift orbital_shift(const OrbitalConfig& config, const ElevationRaster& frame, std::uint64_t seed) {
  const double wave_px = config.distortion_wave_m / frame.resolution_m;
  return {noise_field(frame.width, frame.height, wave_px, config.distortion_m, seed),
          noise_field(frame.width, frame.height, wave_px, config.distortion_m, seed + 1)};
}

void blur(ElevationRaster& raster, double sigma_px) {
  const std::vector<double> kernel = gaussian_kernel(sigma_px);
  smooth_along(raster, kernel, true);
  smooth_along(raster, kernel, false);
}

}  // namespace rover
