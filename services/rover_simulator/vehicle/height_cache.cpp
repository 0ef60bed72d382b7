#include "rover_simulator/vehicle/height_cache.hpp"

#include <cmath>

namespace rover {
namespace {

constexpr double kSampleM = 0.01;
constexpr int kWindow = 16;  // tiles a side: 5.1 m, more than the vehicle

}  // namespace

HeightCache::HeightCache(const Surface& surface) : surface_(surface), slots_(kWindow * kWindow) {}

HeightCache::Tile& HeightCache::tile_at(std::int64_t tx, std::int64_t ty) {
  Tile& tile = slots_[static_cast<size_t>((tx & (kWindow - 1)) + (ty & (kWindow - 1)) * kWindow)];
  if (tile.tx == tx && tile.ty == ty) return tile;
  tile.tx = tx;
  tile.ty = ty;
  tile.material.clear();
  tile.height_m.resize((kCells + 1) * (kCells + 1));
  for (int j = 0; j <= kCells; ++j)
    for (int i = 0; i <= kCells; ++i)
      tile.height_m[static_cast<size_t>(j * (kCells + 1) + i)] = static_cast<float>(surface_.height_m(
          static_cast<double>(tx * kCells + i) * kSampleM, static_cast<double>(ty * kCells + j) * kSampleM));
  return tile;
}

void HeightCache::fill_material(Tile& tile) {
  for (int j = 0; j <= kCells; ++j)
    for (int i = 0; i <= kCells; ++i)
      tile.material.push_back(surface_.material(static_cast<double>(tile.tx * kCells + i) * kSampleM,
                                                static_cast<double>(tile.ty * kCells + j) * kSampleM));
}

double HeightCache::height_m(double x_m, double y_m) {
  const double px = x_m / kSampleM, py = y_m / kSampleM;
  const double fx = std::floor(px), fy = std::floor(py);
  const auto ix = static_cast<std::int64_t>(fx), iy = static_cast<std::int64_t>(fy);
  // The arithmetic shift floors, also west and south of the origin.
  static_assert(kCells == 1 << 5);
  const Tile& tile = tile_at(ix >> 5, iy >> 5);
  const float* z = &tile.height_m[static_cast<size_t>((iy & (kCells - 1)) * (kCells + 1) + (ix & (kCells - 1)))];
  const double u = px - fx, v = py - fy;
  const double south = z[0] + u * (z[1] - z[0]);
  const double north = z[kCells + 1] + u * (z[kCells + 2] - z[kCells + 1]);
  return south + v * (north - south);
}

Material HeightCache::material(double x_m, double y_m) {
  const auto ix = static_cast<std::int64_t>(std::floor(x_m / kSampleM + 0.5));
  const auto iy = static_cast<std::int64_t>(std::floor(y_m / kSampleM + 0.5));
  Tile& tile = tile_at(ix >> 5, iy >> 5);
  if (tile.material.empty()) fill_material(tile);
  return tile.material[static_cast<size_t>((iy & (kCells - 1)) * (kCells + 1) + (ix & (kCells - 1)))];
}

}  // namespace rover
