#include "rover_simulator/world/soil.hpp"

#include <algorithm>
#include <vector>

#include "rover_simulator/world/noise.hpp"

namespace rover {
namespace {

constexpr double kBorder = 0.25;  // blend width, in standard deviations of the noise

double smooth_step(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace

SoilZones::SoilZones(const SoilConfig& config, std::uint64_t seed) : config_(config), seed_(seed) {
  // Thresholds are noise quantiles, sampled on a large grid incommensurate with the noise lattice.
  constexpr int kGrid = 96;
  constexpr double kStep = 0.7239;
  std::vector<double> samples;
  for (int i = 0; i < kGrid; ++i)
    for (int j = 0; j < kGrid; ++j) samples.push_back(zone(i * kStep * config.patch_m, j * kStep * config.patch_m));
  std::sort(samples.begin(), samples.end());
  const auto quantile = [&](double p) {
    return samples[std::min(samples.size() - 1, static_cast<size_t>(p * static_cast<double>(samples.size())))];
  };
  sand_below_ = quantile(config.sand_fraction);
  bedrock_above_ = quantile(1.0 - config.bedrock_fraction);
}

double SoilZones::zone(double x_m, double y_m) const {
  constexpr double kFineAmplitude = 0.4, kNorm = 0.92848;  // 1 / sqrt(1 + kFine^2)
  const double x = x_m / config_.patch_m, y = y_m / config_.patch_m;
  return kNorm * (gradient_noise(seed_, x, y) + kFineAmplitude * gradient_noise(seed_ + 1, 3.1 * x, 3.1 * y));
}

Soil SoilZones::soil(double zone, double slope_rad) const {
  if (config_.everywhere) return *config_.everywhere;
  if (slope_rad > config_.bedrock_min_slope_rad || zone > bedrock_above_) return Soil::kBedrock;
  return zone < sand_below_ && slope_rad < config_.sand_max_slope_rad ? Soil::kSand : Soil::kFirm;
}

SoilZones::Blend SoilZones::blend(double zone) const {
  if (config_.everywhere)
    return {*config_.everywhere == Soil::kSand ? 1.0 : 0.0, *config_.everywhere == Soil::kBedrock ? 1.0 : 0.0};
  return {smooth_step(0.5 + (sand_below_ - zone) / kBorder), smooth_step(0.5 + (zone - bedrock_above_) / kBorder)};
}

}  // namespace rover
