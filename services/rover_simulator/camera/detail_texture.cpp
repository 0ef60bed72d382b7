#include "rover_simulator/camera/detail_texture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "rover_simulator/camera/counter_hash.hpp"

namespace rover {
namespace {

constexpr int kSize = DetailTexture::kSize;
using Field = std::vector<float>;

size_t cell(int u, int v) {
  return static_cast<size_t>(v & (kSize - 1)) * kSize + static_cast<size_t>(u & (kSize - 1));
}

Field white_noise(std::uint64_t seed) {
  Field field(static_cast<size_t>(kSize) * kSize);
  for (size_t i = 0; i < field.size(); ++i) {
    const std::uint64_t h = hash64(seed, i);
    field[i] = near_normal(static_cast<std::uint32_t>(h), static_cast<std::uint32_t>(h >> 32));
  }
  return field;
}

// Periodic Gaussian blur.
Field blurred(const Field& in, double sigma) {
  const int reach = static_cast<int>(std::ceil(3.5 * sigma));
  std::vector<float> kernel;
  float sum = 0.0F;
  for (int k = -reach; k <= reach; ++k) {
    kernel.push_back(static_cast<float>(std::exp(-0.5 * k * k / (sigma * sigma))));
    sum += kernel.back();
  }
  for (float& weight : kernel) weight /= sum;
  Field rows(in.size());
  Field out(in.size());
  for (int v = 0; v < kSize; ++v)
    for (int u = 0; u < kSize; ++u)
      for (int k = -reach; k <= reach; ++k) rows[cell(u, v)] += kernel[k + reach] * in[cell(u + k, v)];
  for (int v = 0; v < kSize; ++v)
    for (int u = 0; u < kSize; ++u)
      for (int k = -reach; k <= reach; ++k) out[cell(u, v)] += kernel[k + reach] * rows[cell(u, v + k)];
  return out;
}

// Zero mean, unit variance.
void normalise(Field& field) {
  double sum = 0.0;
  double squares = 0.0;
  for (float value : field) sum += value;
  const double mean = sum / static_cast<double>(field.size());
  for (float value : field) squares += (value - mean) * (value - mean);
  const double sigma = std::sqrt(squares / static_cast<double>(field.size()));
  for (float& value : field) value = static_cast<float>((value - mean) / sigma);
}

// Difference of Gaussians: band-pass of about two octaves around kWavelengthTexels.
Field band_noise(std::uint64_t seed) {
  const double sigma = DetailTexture::kWavelengthTexels / (2.0 * std::numbers::pi);
  const Field white = white_noise(seed);
  Field fine = blurred(white, 0.75 * sigma);
  const Field coarse = blurred(white, 2.2 * sigma);
  for (size_t i = 0; i < fine.size(); ++i) fine[i] -= coarse[i];
  normalise(fine);
  return fine;
}

struct Relief {
  Field tone;
  Field height;
};

Relief band_relief(std::uint64_t seed) {
  return {band_noise(seed), band_noise(hash64(seed, 5))};
}

// Domed pebbles of uniform tone, drawn over each other on finer noise.
Relief grain_relief(std::uint64_t seed) {
  Relief relief = band_relief(seed);
  for (float& value : relief.tone) value *= 0.5F;
  for (float& value : relief.height) value *= 0.3F;
  constexpr int kGrains = kSize * kSize / 110;
  for (int i = 0; i < kGrains; ++i) {
    const std::uint64_t h = hash64(hash64(seed, 77), static_cast<std::uint64_t>(i));
    const int cu = static_cast<int>(h & 511);
    const int cv = static_cast<int>((h >> 9) & 511);
    const double radius = 1.4 + 3.6 * std::pow(unit_random(hash64(h)), 4.0);
    const double tone = 3.0 * unit_random(hash64(h, 1)) - 1.9;
    const int reach = static_cast<int>(std::ceil(radius + 1.0));
    for (int v = -reach; v <= reach; ++v) {
      for (int u = -reach; u <= reach; ++u) {
        const double r = std::hypot(u, v);
        const double cover = std::clamp(radius + 0.5 - r, 0.0, 1.0);
        float& value = relief.tone[cell(cu + u, cv + v)];
        value = static_cast<float>(value + cover * (tone - value));
        float& height = relief.height[cell(cu + u, cv + v)];
        height = std::max(height, static_cast<float>(std::sqrt(std::max(radius * radius - r * r, 0.0))));
      }
    }
  }
  normalise(relief.tone);
  return relief;
}

std::uint32_t to_byte(double value) {
  return static_cast<std::uint8_t>(std::clamp(std::lround(value / DetailTexture::kUnit), -127L, 127L));
}

DetailLayer make_layer(int index, double texel_m, std::uint64_t seed) {
  const std::uint64_t h = hash64(seed, static_cast<std::uint64_t>(1000 + index));
  const double angle = 2.0 * std::numbers::pi * unit_random(h);
  DetailLayer layer;
  layer.texel_m = texel_m;
  layer.grains = index <= 1;
  layer.texels_per_m << std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle);
  layer.texels_per_m /= texel_m;
  layer.offset = {kSize * unit_random(hash64(h, 1)), kSize * unit_random(hash64(h, 2))};
  return layer;
}

}  // namespace

DetailTexture::DetailTexture(std::uint64_t seed, bool grains) : texels_(static_cast<size_t>(kSize) * kSize) {
  const Relief relief = grains ? grain_relief(seed) : band_relief(seed);
  const Field& z = relief.height;
  const auto slope_u = [&](int u, int v) { return 0.5 * (z[cell(u + 1, v)] - z[cell(u - 1, v)]); };
  const auto slope_v = [&](int u, int v) { return 0.5 * (z[cell(u, v + 1)] - z[cell(u, v - 1)]); };
  double squares = 0.0;
  for (int v = 0; v < kSize; ++v)
    for (int u = 0; u < kSize; ++u) squares += slope_u(u, v) * slope_u(u, v) + slope_v(u, v) * slope_v(u, v);
  const double sigma = std::sqrt(squares / (static_cast<double>(kSize) * kSize));
  for (int v = 0; v < kSize; ++v)
    for (int u = 0; u < kSize; ++u)
      texels_[cell(u, v)] =
          static_cast<std::int32_t>(to_byte(relief.tone[cell(u, v)]) | to_byte(slope_u(u, v) / sigma) << 8 |
                                    to_byte(slope_v(u, v) / sigma) << 16);
}

GroundTexture::GroundTexture(std::uint64_t seed) : noise(hash64(seed, 11), false), grains(hash64(seed, 12), true) {
  // Centre wavelengths from 4.8 mm (two pixels at 1 m) to 1.3 m (covered by the terrain's roughness).
  double texel_m = 0.0008;
  for (int i = 0; i < kDetailLayers; ++i, texel_m *= 4.07) layers[i] = make_layer(i, texel_m, seed);
}

}  // namespace rover
