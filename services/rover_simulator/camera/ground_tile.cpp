#include "rover_simulator/camera/ground_tile.hpp"

#include <cmath>

#include "common/core/check.hpp"
#include "rover_simulator/camera/sun_horizon.hpp"

namespace rover {

Eigen::Vector2i sun_side(const GroundAppearanceConfig& config) {
  return {std::cos(config.sun_azimuth_rad) >= 0.0 ? 1 : -1, std::sin(config.sun_azimuth_rad) >= 0.0 ? 1 : -1};
}

GroundTile::GroundTile(RTCDevice device, const Heights& heights, const Surface& surface,
                       const GroundAppearance& appearance, const GroundTexture& texture)
    : GroundTile(device, *heights.self) {
  place_textures(texture);
  shade_vertices(heights, surface, appearance, texture);
}

GroundTile::GroundTile(RTCDevice device, const HeightTile& heights)
    : key_(heights.key), origin_(key_.x_m(), key_.y_m(), heights.base_m) {
  if (device != nullptr) build_mesh(device, heights);
}

GroundTile::~GroundTile() {
  if (scene_ != nullptr) rtcReleaseScene(scene_);
}

// Reduced modulo the texture period in double precision, so single precision suffices afterwards.
void GroundTile::place_textures(const GroundTexture& texture) {
  for (int layer = 0; layer < kDetailLayers; ++layer) {
    const DetailLayer& at = texture.layers[layer];
    for (int plane = 0; plane < kPlanes; ++plane) {
      const auto& [a, b] = kPlaneAxes[plane];
      const Eigen::Array2d uv = at.offset + at.texels_per_m * Eigen::Vector2d(origin_[a], origin_[b]);
      texture_origin_[layer][plane] =
          (uv - DetailTexture::kSize * (uv / DetailTexture::kSize).floor()).matrix().cast<float>();
    }
  }
}

void GroundTile::shade_vertices(const Heights& heights, const Surface& surface, const GroundAppearance& appearance,
                                const GroundTexture& texture) {
  const TileLevel& level = kLevels[key_.level];
  const std::vector<float> margins = sun_margins(heights, appearance.config());
  const auto slope_per_m = static_cast<float>(0.5 / level.spacing_m);
  vertices_.resize(margins.size());
  for (int j = 0; j <= level.cells; ++j) {
    for (int i = 0; i <= level.cells; ++i) {
      const size_t index = static_cast<size_t>(j) * (level.cells + 1) + i;
      const HeightTile& z = *heights.self;
      const double x = origin_.x() + i * level.spacing_m;
      const double y = origin_.y() + j * level.spacing_m;
      VertexAppearance vertex = appearance.at(x, y, surface.material(x, y));
      if (baked()) {
        const float tone =
            baked_tone(texture, static_cast<float>(x - origin_.x()), static_cast<float>(y - origin_.y()));
        vertex.albedo *= std::max(1.0F + vertex.coarse_contrast * tone, 0.4F);
      }
      vertices_[index].surface = Float4{slope_per_m * (z.at(i + 1, j) - z.at(i - 1, j)),
                                        slope_per_m * (z.at(i, j + 1) - z.at(i, j - 1)), margins[index], 0.0F};
      vertices_[index].appearance = Float4{vertex.albedo, vertex.fine_contrast, vertex.coarse_contrast, vertex.bump};
    }
  }
}

float GroundTile::baked_tone(const GroundTexture& texture, float x, float y) const {
  float tone = 0.0F;
  for (int k = kFirstBakedLayer; k < kDetailLayers; ++k) {
    const DetailLayer& layer = texture.layers[k];
    const Eigen::Vector2f uv = texture_origin(k, 0) + layer.texels_per_m.cast<float>() * Eigen::Vector2f(x, y);
    tone += texture.of(layer).sample(uv.x(), uv.y())[0];
  }
  return tone;
}

// Embree grid with a skirt: the outermost ring is half a cell outside and below the rim, under the neighbours.
void GroundTile::build_mesh(RTCDevice device, const HeightTile& heights) {
  const TileLevel& level = kLevels[key_.level];
  const int side = level.cells + 3;
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_GRID);
  auto* xyz = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                          3 * sizeof(float), static_cast<size_t>(side) * side));
  ROVER_CHECK(xyz != nullptr);
  const auto coordinate = [&](int i) {
    return static_cast<float>(std::clamp(i, 0, level.cells) * level.spacing_m + (i < 0             ? -0.5
                                                                                 : i > level.cells ? 0.5
                                                                                                   : 0.0) *
                                                                                    level.spacing_m);
  };
  for (int j = -1; j <= level.cells + 1; ++j) {
    for (int i = -1; i <= level.cells + 1; ++i) {
      const int in_i = std::clamp(i, 0, level.cells);
      const int in_j = std::clamp(j, 0, level.cells);
      const bool skirt = in_i != i || in_j != j;
      *xyz++ = coordinate(i);
      *xyz++ = coordinate(j);
      *xyz++ = heights.at(in_i, in_j) - (skirt ? static_cast<float>(level.skirt_m) : 0.0F);
    }
  }
  auto* grid = static_cast<RTCGrid*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_GRID, 0, RTC_FORMAT_GRID, sizeof(RTCGrid), 1));
  *grid = {0, static_cast<unsigned>(side), static_cast<std::uint16_t>(side), static_cast<std::uint16_t>(side)};
  rtcCommitGeometry(geometry);
  scene_ = rtcNewScene(device);
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);  // watertight: no misses between triangles
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_);
  ROVER_CHECK(rtcGetDeviceError(device) == RTC_ERROR_NONE);
}

size_t GroundTile::memory_bytes() const {
  // Per vertex: shading, mesh and Embree's BVH (19 bytes measured on Gale terrain).
  return vertices_.size() * (sizeof(ShadingVertex) + 3 * sizeof(float) + 19);
}

}  // namespace rover
