#include "rover_simulator/world/world.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/core/check.hpp"
#include "rover_simulator/world/noise.hpp"
#include "rover_simulator/world/rover_streams.hpp"

namespace rover {
namespace {

// Independent random stream per part of the world.
enum Stream : std::uint64_t { kRocks = 1, kSoil = 2, kRoughness = 3 };
std::uint64_t stream_seed(std::uint64_t seed, Stream stream) {
  return hash_cell(seed, stream, 0);
}

// Cubic convolution (Keys 1981, a = -1/2): weights and their derivatives for the four neighbours.
struct Cubic {
  std::array<double, 4> weight, derivative;
};
Cubic cubic(double t) {
  const double t2 = t * t, t3 = t2 * t;
  return {{0.5 * (-t3 + 2 * t2 - t), 0.5 * (3 * t3 - 5 * t2 + 2), 0.5 * (-3 * t3 + 4 * t2 + t), 0.5 * (t3 - t2)},
          {0.5 * (-3 * t2 + 4 * t - 1), 0.5 * (9 * t2 - 10 * t), 0.5 * (-9 * t2 + 8 * t + 1), 0.5 * (3 * t2 - 2 * t)}};
}

std::vector<double> octave_amplitudes(const RoughnessConfig& config) {
  std::vector<double> rms;
  double power = 0.0;
  for (int i = 0; i < config.octaves; ++i) {
    rms.push_back(std::pow(0.5, config.hurst * i));
    power += rms.back() * rms.back();
  }
  for (double& r : rms) r *= config.rms_m / std::sqrt(power);
  return rms;
}

std::vector<KeepClear> about_true_start(std::vector<KeepClear> circles, std::uint64_t seed) {
  const std::array<double, 3> error = start_error(seed);
  for (KeepClear& circle : circles) {
    circle.x_m += circle.start_sigma_m * error[0];
    circle.y_m += circle.start_sigma_m * error[1];
  }
  return circles;
}

}  // namespace

World::World(const WorldConfig& config, const ElevationRaster& dtm, std::uint64_t seed)
    : config_(config),
      dtm_(dtm),
      seed_(seed),
      soils_(config.soil, stream_seed(seed, kSoil)),
      rocks_(config.rocks, dtm.width_m(), dtm.height_m(), about_true_start(config.keep_clear, seed),
             stream_seed(seed, kRocks)),
      octave_rms_m_(octave_amplitudes(config.roughness)) {
  ROVER_CHECK(dtm.width >= 4 && dtm.height >= 4 && dtm.resolution_m > 0.0, dtm.width, dtm.height, dtm.resolution_m);
  const float lowest = *std::min_element(dtm_.z_m.begin(), dtm_.z_m.end());
  for (float& z : dtm_.z_m) z -= lowest;
  datum_m_ = lowest;
}

World::Ground World::smooth_ground(double x_m, double y_m) const {
  const double px = std::clamp(x_m / dtm_.resolution_m - 0.5, 0.0, dtm_.width - 1.0);
  const double py = std::clamp(y_m / dtm_.resolution_m - 0.5, 0.0, dtm_.height - 1.0);
  const int ix = std::min(static_cast<int>(px), dtm_.width - 2), iy = std::min(static_cast<int>(py), dtm_.height - 2);
  const Cubic cx = cubic(px - ix), cy = cubic(py - iy);
  double z = 0.0, zx = 0.0, zy = 0.0;
  for (int j = 0; j < 4; ++j) {
    const int row = std::clamp(iy - 1 + j, 0, dtm_.height - 1);
    double line = 0.0, slope = 0.0;
    for (int i = 0; i < 4; ++i) {
      const double value = dtm_.at(std::clamp(ix - 1 + i, 0, dtm_.width - 1), row);
      line += cx.weight[i] * value;
      slope += cx.derivative[i] * value;
    }
    z += cy.weight[j] * line;
    zx += cy.weight[j] * slope;
    zy += cy.derivative[j] * line;
  }
  return {z, std::atan(std::hypot(zx, zy) / dtm_.resolution_m)};
}

double World::roughness_m(double x_m, double y_m) const {
  if (config_.roughness.rms_m <= 0.0) return 0.0;
  double sum = 0.0, wave_m = config_.roughness.longest_wave_m;
  for (size_t i = 0; i < octave_rms_m_.size(); ++i, wave_m *= 0.5)
    sum += octave_rms_m_[i] * gradient_noise(stream_seed(seed_, kRoughness) + i, x_m / wave_m, y_m / wave_m);
  const SoilZones::Blend blend = soils_.blend(soils_.zone(x_m, y_m));
  return sum * (1.0 + blend.sand * (config_.roughness.sand_factor - 1.0) +
                blend.bedrock * (config_.roughness.bedrock_factor - 1.0));
}

double World::smooth_height_m(double x_m, double y_m) const {
  return smooth_ground(x_m, y_m).height_m;
}

double World::ground_height_m(double x_m, double y_m) const {
  return smooth_ground(x_m, y_m).height_m + roughness_m(x_m, y_m);
}

double World::height_m(double x_m, double y_m) const {
  return ground_height_m(x_m, y_m) + rocks_.at(x_m, y_m).height_m;
}

Material World::material(double x_m, double y_m) const {
  const RockField::Hit hit = rocks_.at(x_m, y_m);
  // Of the rock's own hash, not its number in this world; 31 bits, never negative.
  if (hit.rock_id >= 0)
    return {Soil::kBedrock, static_cast<int>(rocks_.all()[static_cast<size_t>(hit.rock_id)].shape_seed >> 33),
            hit.height_m};
  return {soils_.soil(soils_.zone(x_m, y_m), smooth_ground(x_m, y_m).slope_rad), -1, 0.0};
}

std::vector<Rock> World::rocks_in(double x0_m, double y0_m, double x1_m, double y1_m) const {
  return rocks_.in(x0_m, y0_m, x1_m, y1_m);
}

bool World::contains(double x_m, double y_m) const {
  return x_m >= 0.0 && y_m >= 0.0 && x_m < width_m() && y_m < length_m();
}

}  // namespace rover
