// Renderable tile: its Embree mesh and shading data per vertex.
#pragma once

#include <embree3/rtcore.h>

#include <Eigen/Dense>
#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "rover_simulator/camera/detail_texture.hpp"
#include "rover_simulator/camera/ground_appearance.hpp"
#include "rover_simulator/camera/height_tile.hpp"

namespace rover {

// Interpolated vertex attributes.
struct ShadingVertex {
  // Slopes along x and y; tangent of sun elevation minus tangent of horizon elevation (negative in shadow).
  Float4 surface;
  Float4 appearance;  // a VertexAppearance
};

class GroundTile {
 public:
  // Height tile and its neighbours towards the sun in x, y and both, at the same level.
  struct Heights {
    std::shared_ptr<const HeightTile> self, next_x, next_y, next_xy;
  };

  // Without a device: no mesh, for radiance alone.
  GroundTile(RTCDevice device, const Heights& heights, const Surface& surface, const GroundAppearance& appearance,
             const GroundTexture& texture);
  // The mesh alone: for ranges, not for radiance.
  GroundTile(RTCDevice device, const HeightTile& heights);
  ~GroundTile();
  GroundTile(const GroundTile&) = delete;
  GroundTile& operator=(const GroundTile&) = delete;

  RTCScene scene() const { return scene_; }
  const TileKey& key() const { return key_; }
  // Long texture wavelengths are baked into the vertex albedo.
  bool baked() const { return key_.level == 0; }
  // Corner with the smallest x and y; origin of the mesh coordinates.
  const Eigen::Vector3d& origin() const { return origin_; }
  // Texture coordinates of the origin.
  const Eigen::Vector2f& texture_origin(int layer, int plane) const { return texture_origin_[layer][plane]; }
  // Row-major, cells + 1 per side.
  const std::vector<ShadingVertex>& vertices() const { return vertices_; }
  size_t memory_bytes() const;

 private:
  void place_textures(const GroundTexture& texture);
  void shade_vertices(const Heights& heights, const Surface& surface, const GroundAppearance& appearance,
                      const GroundTexture& texture);
  float baked_tone(const GroundTexture& texture, float x, float y) const;
  void build_mesh(RTCDevice device, const HeightTile& heights);

  TileKey key_;
  Eigen::Vector3d origin_;
  std::array<std::array<Eigen::Vector2f, kPlanes>, kDetailLayers> texture_origin_;
  std::vector<ShadingVertex> vertices_;
  RTCScene scene_ = nullptr;
};

// Signs of the direction towards the sun: +1 or -1 in x and y.
Eigen::Vector2i sun_side(const GroundAppearanceConfig& config);

}  // namespace rover
