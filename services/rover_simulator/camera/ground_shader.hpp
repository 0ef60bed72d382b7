// Radiance of the ground: Lambertian, with shadowed sun and diffuse sky.
#pragma once

#include <array>

#include "rover_simulator/camera/ground_tile.hpp"
#include "rover_simulator/camera/ray_packet.hpp"

namespace rover {

class GroundShader {
 public:
  GroundShader(const GroundAppearanceConfig& config, const GroundTexture& texture);

  // Ground intersections of eight rays.
  struct Points {
    Lanes<const GroundTile*> tile;  // null: sky
    Lanes<float> x, y, z;           // relative to the tile's origin
    Lanes<float> pixel_m;           // pixel width at that range, perpendicular to the ray
  };
  Lanes<float> radiance(const RayPacket& rays, const Points& points) const;

 private:
  struct Layer {
    const DetailTexture* texture;
    float cosine, sine;  // of its rotation
    float texels_per_m;
    float wavelength_m;
    bool fine;
  };
  struct State;
  // Normals, resolvable wavelengths and texture planes.
  [[gnu::always_inline]] inline void face(const RayPacket& rays, const Points& points, State& state) const;
  [[gnu::always_inline]] inline void add_layer(int index, const Points& points, State& state) const;

  std::array<Layer, kDetailLayers> layers_;
  float sun_x_, sun_y_, sun_z_;
  float sky_light_;
};

}  // namespace rover
