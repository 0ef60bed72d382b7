#include "rover_simulator/camera/ground_appearance.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "rover_simulator/camera/counter_hash.hpp"

namespace rover {
namespace {

constexpr double kDustPatch_m = 1.5;  // lattice of the dust noise; patches are 1 to 2 m wide

std::uint64_t lattice_hash(std::uint64_t seed, std::int64_t ix, std::int64_t iy) {
  return hash64(hash64(seed, static_cast<std::uint64_t>(ix)), static_cast<std::uint64_t>(iy));
}

double smooth(double t) {
  return t * t * (3.0 - 2.0 * t);
}

// Value noise in [0, 1].
double value_noise(std::uint64_t seed, double x, double y) {
  const double fx = std::floor(x);
  const double fy = std::floor(y);
  const auto ix = static_cast<std::int64_t>(fx);
  const auto iy = static_cast<std::int64_t>(fy);
  const double u = smooth(x - fx);
  const double v = smooth(y - fy);
  const auto corner = [&](int i, int j) { return unit_random(lattice_hash(seed, ix + i, iy + j)); };
  return (1.0 - v) * ((1.0 - u) * corner(0, 0) + u * corner(1, 0)) + v * ((1.0 - u) * corner(0, 1) + u * corner(1, 1));
}

// Quantile of value_noise at this probability.
double noise_quantile(double fraction) {
  constexpr int kSide = 150;
  std::vector<double> values;
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) values.push_back(value_noise(1, 0.618 * i, 0.618 * j));
  const double place = std::clamp(fraction, 0.0, 1.0) * static_cast<double>(values.size() - 1);
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// Albedos and contrasts are tuned visually to images of Mars rovers.
VertexAppearance soil_look(Soil soil) {
  switch (soil) {
    case Soil::kSand:
      return {0.30F, 0.13F, 0.06F, 0.10F};
    case Soil::kFirm:
      return {0.25F, 0.20F, 0.08F, 0.16F};
    case Soil::kBedrock:
      return {0.34F, 0.17F, 0.12F, 0.12F};
  }
  return {};
}

VertexAppearance rock_look(std::uint64_t seed, int rock_id) {
  const auto tone = static_cast<float>(unit_random(hash64(hash64(seed, 31), static_cast<std::uint64_t>(rock_id))));
  return {0.15F + 0.15F * tone, 0.17F, 0.13F, 0.16F};
}

void cover(VertexAppearance& appearance, double dust) {
  constexpr float kDustAlbedo = 0.33F;
  constexpr float kResidualContrast = 0.04F;  // remaining contrast under dust
  const auto d = static_cast<float>(dust);
  appearance.albedo += d * (kDustAlbedo - appearance.albedo);
  const float keep = 1.0F - d * (1.0F - kResidualContrast);
  appearance.fine_contrast *= keep;
  appearance.coarse_contrast *= keep;
  appearance.bump *= keep;
}

}  // namespace

GroundAppearance::GroundAppearance(const GroundAppearanceConfig& config)
    : config_(config), dust_below_(noise_quantile(config.textureless_fraction)) {}

VertexAppearance GroundAppearance::at(double x, double y, const Material& material) const {
  const bool rock = material.rock_id >= 0;
  VertexAppearance appearance = rock ? rock_look(config_.seed, material.rock_id) : soil_look(material.soil);
  cover(appearance, rock ? dust_on_rock(material.rock_id) : dust_on_ground(x, y));
  return appearance;
}

double GroundAppearance::dust_on_ground(double x, double y) const {
  if (config_.textureless_fraction <= 0.0) return 0.0;
  if (config_.textureless_fraction >= 1.0) return 1.0;
  const double noise = value_noise(hash64(config_.seed, 41), x / kDustPatch_m, y / kDustPatch_m);
  constexpr double kEdge = 0.03;  // soft rim
  return smooth(std::clamp((dust_below_ - noise) / kEdge + 0.5, 0.0, 1.0));
}

double GroundAppearance::dust_on_rock(int rock_id) const {
  const std::uint64_t h = hash64(hash64(config_.seed, 51), static_cast<std::uint64_t>(rock_id));
  return unit_random(h) < config_.textureless_rock_fraction ? 1.0 : 0.0;
}

}  // namespace rover
