// What the ground looks like: light, albedo and contrast by material, dust.
#pragma once

#include <cstdint>

#include "rover_simulator/world/surface.hpp"

namespace rover {

struct GroundLookConfig {
  double sun_elevation_rad = 0.7;
  double sun_azimuth_rad = 1.0;             // towards the sun, counter-clockwise from map x
  double sky_light = 0.16;                  // diffuse over direct irradiance; an estimate for little dust in the air
  double textureless_fraction = 0.03;       // share of the ground under smooth dust
  double textureless_rock_fraction = 0.02;  // share of the rocks with a smooth, dusty skin
  std::uint64_t seed = 1;
};

// Look of one vertex; values between vertices are interpolated.
struct VertexLook {
  float albedo = 0.0F;
  float fine_contrast = 0.0F;    // relative, of layers with wavelengths below 5 cm
  float coarse_contrast = 0.0F;  // and above
  float bump = 0.0F;             // slope (rms) of the relief below the mesh's resolution
};

class GroundLook {
 public:
  explicit GroundLook(const GroundLookConfig& config);
  VertexLook at(double x, double y, const Material& material) const;
  const GroundLookConfig& config() const { return config_; }

 private:
  // 0: none, 1: smooth dust hides all texture.
  double dust_on_ground(double x, double y) const;
  double dust_on_rock(int rock_id) const;

  GroundLookConfig config_;
  double dust_below_;  // level of the dust noise
};

}  // namespace rover
