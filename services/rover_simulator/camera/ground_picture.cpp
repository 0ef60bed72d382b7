#include "rover_simulator/camera/ground_picture.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "rover_simulator/camera/ground_shader.hpp"
#include "rover_simulator/camera/ground_tile.hpp"
#include "rover_simulator/camera/worker_pool.hpp"

namespace rover {
namespace {

constexpr int kLevel = 1;  // of detail
static_assert(kLevels[kLevel].spacing_m == kPictureSampleM);

using HeightRow = std::vector<std::shared_ptr<const HeightTile>>;

void shade(const GroundTile& tile, const GroundShader& shader, ElevationRaster& picture) {
  const int cells = kLevels[kLevel].cells;
  const int column0 = tile.key().ix * cells, row0 = tile.key().iy * cells;
  RayPacket down{};
  GroundShader::Points points{};
  for (int k = 0; k < kPacket; ++k) {
    down.dir_z[k] = -1.0F;
    down.cosine[k] = 1.0F;
    points.tile[k] = &tile;
    points.pixel_m[k] = static_cast<float>(kPictureSampleM);
  }
  for (int j = 0; j < std::min(cells, picture.height - row0); ++j)
    for (int i = 0; i < cells; i += kPacket) {
      for (int k = 0; k < kPacket; ++k) {
        points.x[k] = static_cast<float>((i + k + 0.5) * kPictureSampleM);
        points.y[k] = static_cast<float>((j + 0.5) * kPictureSampleM);
      }
      const Lanes<float> radiance = shader.radiance(down, points);
      for (int k = 0; k < std::min(kPacket, picture.width - column0 - i); ++k)
        picture.at(column0 + i + k, row0 + j) = radiance[k];
    }
}

}  // namespace

ElevationRaster ground_picture(const Surface& surface, const GroundAppearanceConfig& config, double width_m,
                               double length_m, int threads) {
  const GroundAppearance appearance(config);
  const GroundTexture texture(config.seed);
  const GroundShader shader(config, texture);
  WorkerPool pool(threads);
  ElevationRaster picture;
  picture.width = static_cast<int>(std::floor(width_m / kPictureSampleM));
  picture.height = static_cast<int>(std::floor(length_m / kPictureSampleM));
  picture.resolution_m = kPictureSampleM;
  picture.z_m.resize(static_cast<size_t>(picture.width) * picture.height);
  const double tile_m = kLevels[kLevel].size_m();
  const int columns = static_cast<int>(std::ceil(width_m / tile_m)),
            rows = static_cast<int>(std::ceil(length_m / tile_m));
  const Eigen::Vector2i sun = sun_side(config);
  const auto heights_of = [&](int iy) {  // with a tile more on both sides
    HeightRow row(static_cast<size_t>(columns) + 2);
    pool.run(columns + 2, [&](int k) { row[k] = std::make_shared<HeightTile>(TileKey{kLevel, k - 1, iy}, surface); });
    return row;
  };
  const int first = sun.y() > 0 ? rows - 1 : 0;  // towards the shadows, so that the sun's side is there
  HeightRow sunward = heights_of(first + sun.y());
  for (int n = 0; n < rows; ++n) {
    const int iy = first - n * sun.y();
    const HeightRow here = heights_of(iy);
    pool.run(columns, [&](int ix) {
      const int k = ix + 1, next = k + sun.x();
      const GroundTile::Heights heights{here[k], here[next], sunward[k], sunward[next]};
      shade(GroundTile(nullptr, heights, surface, appearance, texture), shader, picture);
    });
    sunward = here;
  }
  return picture;
}

}  // namespace rover
