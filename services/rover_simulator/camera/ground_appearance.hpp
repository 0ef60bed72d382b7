// Appearance of the ground: illumination, albedo and contrast by material, dust.
#pragma once

#include <cstdint>

#include "rover_simulator/world/surface.hpp"

namespace rover {

struct GroundAppearanceConfig {
  double sun_elevation_rad = 0.7;
  double sun_azimuth_rad = 1.0;             // towards the sun, counter-clockwise from map x
  double sky_light = 0.16;                  // diffuse over direct irradiance, estimated for low atmospheric dust
  double textureless_fraction = 0.03;       // fraction of the ground covered by smooth dust
  double textureless_rock_fraction = 0.02;  // fraction of the rocks covered by smooth dust
  std::uint64_t seed = 1;
};

// Appearance of one vertex, interpolated between vertices.
struct VertexAppearance {
  float albedo = 0.0F;
  float fine_contrast = 0.0F;    // relative, wavelengths below 5 cm
  float coarse_contrast = 0.0F;  // relative, wavelengths above 5 cm
  float bump = 0.0F;             // rms slope of relief below mesh resolution
};

class GroundAppearance {
 public:
  explicit GroundAppearance(const GroundAppearanceConfig& config);
  VertexAppearance at(double x, double y, const Material& material) const;
  const GroundAppearanceConfig& config() const { return config_; }

 private:
  // Dust cover from 0 to 1; 1 hides all texture.
  double dust_on_ground(double x, double y) const;
  double dust_on_rock(int rock_id) const;

  GroundAppearanceConfig config_;
  double dust_below_;  // dust where the noise is below this level
};

}  // namespace rover
