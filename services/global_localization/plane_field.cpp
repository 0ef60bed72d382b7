#include "global_localization/plane_field.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace rover::global {
namespace {

using Field = std::vector<double>;
using Kernel = std::vector<double>;

// u^power times the normalised Gaussian, u in cells.
Kernel moment_kernel(double sigma, int power) {
  const int radius = static_cast<int>(std::ceil(3.0 * sigma));
  double sum = 0.0;
  for (int u = -radius; u <= radius; ++u) sum += std::exp(-0.5 * u * u / (sigma * sigma));
  Kernel kernel;
  for (int u = -radius; u <= radius; ++u)
    kernel.push_back(std::pow(u, power) * std::exp(-0.5 * u * u / (sigma * sigma)) / sum);
  return kernel;
}

// One pass of the separable filter; cells beyond the border have weight 0.
Field filtered(const Field& in, const Lattice& lattice, const Kernel& kernel, bool along_rows) {
  const int radius = static_cast<int>(kernel.size() / 2);
  const int length = along_rows ? lattice.columns : lattice.rows, lines = along_rows ? lattice.rows : lattice.columns;
  const size_t step = along_rows ? 1 : static_cast<size_t>(lattice.columns);
  const size_t line_step = along_rows ? static_cast<size_t>(lattice.columns) : 1;
  Field out(in.size(), 0.0);
  for (int line = 0; line < lines; ++line)
    for (int i = 0; i < length; ++i) {
      const size_t base = static_cast<size_t>(line) * line_step;
      double sum = 0.0;
      for (int k = std::max(i - radius, 0); k <= std::min(i + radius, length - 1); ++k)
        sum += kernel[static_cast<size_t>(k - i + radius)] * in[base + static_cast<size_t>(k) * step];
      out[base + static_cast<size_t>(i) * step] = sum;
    }
  return out;
}

double weighted_mean(const HeightGrid& heights) {
  double sum = 0.0, weight = 0.0;
  for (size_t i = 0; i < heights.z_m.size(); ++i) {
    if (heights.weight[i] <= 0.0f) continue;
    sum += static_cast<double>(heights.weight[i]) * heights.z_m[i];
    weight += heights.weight[i];
  }
  return weight > 0.0 ? sum / weight : 0.0;
}

// Gaussian-weighted moments of weight w, offsets u, v [cells] and height z.
struct Moments {
  Field w, wu, wv, wuu, wuv, wvv, wz, wuz, wvz;
};

Moments moments_of(const HeightGrid& heights, double sigma) {
  const Lattice& lattice = heights.lattice;
  const double mean = weighted_mean(heights);
  Field w(lattice.size()), z(lattice.size());
  for (size_t i = 0; i < w.size(); ++i) {
    w[i] = heights.weight[i];
    z[i] = w[i] > 0.0 ? w[i] * (heights.z_m[i] - mean) : 0.0;
  }
  const Kernel k0 = moment_kernel(sigma, 0), k1 = moment_kernel(sigma, 1), k2 = moment_kernel(sigma, 2);
  const Field w0 = filtered(w, lattice, k0, true), w1 = filtered(w, lattice, k1, true);
  const Field w2 = filtered(w, lattice, k2, true);
  const Field z0 = filtered(z, lattice, k0, true), z1 = filtered(z, lattice, k1, true);
  const auto down = [&](const Field& field, const Kernel& kernel) { return filtered(field, lattice, kernel, false); };
  return {down(w0, k0), down(w1, k0), down(w0, k1), down(w2, k0), down(w1, k1),
          down(w0, k2), down(z0, k0), down(z1, k0), down(z0, k1)};
}

}  // namespace

PlaneField plane_field(const HeightGrid& heights, const PlaneConfig& config) {
  const Moments m = moments_of(heights, config.sigma_cells);
  const size_t size = heights.lattice.size();
  PlaneField field{heights.lattice, std::vector<float>(size, 0.0f), std::vector<float>(size, 0.0f),
                   std::vector<float>(size, 0.0f), std::vector<std::uint8_t>(size, 0)};
  const double full_spread = config.sigma_cells * config.sigma_cells;
  for (size_t i = 0; i < size; ++i) {
    if (m.w[i] < config.min_support) continue;
    const double u = m.wu[i] / m.w[i], v = m.wv[i] / m.w[i], z = m.wz[i] / m.w[i];
    Eigen::Matrix2d spread;
    spread << m.wuu[i] - m.wu[i] * u, m.wuv[i] - m.wu[i] * v, m.wuv[i] - m.wu[i] * v, m.wvv[i] - m.wv[i] * v;
    const double half_trace = 0.5 * spread.trace();
    const double min_eigenvalue = half_trace - std::sqrt(std::max(half_trace * half_trace - spread.determinant(), 0.0));
    if (min_eigenvalue < 0.5 * config.min_support * full_spread) continue;
    const Eigen::Vector2d slope = spread.inverse() * Eigen::Vector2d(m.wuz[i] - m.wz[i] * u, m.wvz[i] - m.wz[i] * v);
    field.z[i] = static_cast<float>(z - slope.x() * u - slope.y() * v);
    field.gx[i] = static_cast<float>(slope.x() / heights.lattice.cell_m);
    field.gy[i] = static_cast<float>(slope.y() / heights.lattice.cell_m);
    field.known[i] = 1;
  }
  return field;
}

}  // namespace rover::global
