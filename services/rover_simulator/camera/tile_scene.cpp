#include "rover_simulator/camera/tile_scene.hpp"

#include <algorithm>
#include <cmath>

#include "common/core/check.hpp"
#include "common/core/frames.hpp"

namespace rover {
namespace {

// Limited to AVX2, because the last bits of a range depend on the instruction set. Embree's threads are not used.
constexpr const char* kDeviceConfig = "threads=1,isa=avx2";

double distance(const TileKey& key, double x, double y) {
  const double size = kLevels[key.level].size_m();
  const double dx = std::max({key.x_m() - x, 0.0, x - key.x_m() - size});
  const double dy = std::max({key.y_m() - y, 0.0, y - key.y_m() - size});
  return std::hypot(dx, dy);
}

int tile_index(int level, double position) {
  return static_cast<int>(std::floor(position / kLevels[level].size_m()));
}

}  // namespace

TileScene::TileScene(const Surface& surface, const TileSceneConfig& config)
    : surface_(surface),
      config_(config),
      appearance_(config.appearance),
      texture_(config.appearance.seed),
      shader_(config.appearance, texture_),
      pool_(config.threads),
      device_(rtcNewDevice(kDeviceConfig)) {
  ROVER_CHECK(device_ != nullptr);
  ROVER_CHECK(config.fine_radius_m < config.middle_radius_m && config.middle_radius_m < config.far_radius_m);
}

TileScene::~TileScene() {
  if (scene_ != nullptr) rtcReleaseScene(scene_);
  shown_tiles_.clear();
  tiles_.clear();
  rtcReleaseDevice(device_);
}

void TileScene::focus(double x_m, double y_m) {
  ROVER_CHECK(std::isfinite(x_m) && std::isfinite(y_m), x_m, y_m);
  const std::vector<TileKey> needed = tiles_around(x_m, y_m, 0.0);
  build(needed);
  if (needed != shown_) {
    assemble(needed);
    evict_distant_tiles(x_m, y_m);
  }
  prefetch_one_tile(x_m, y_m);
}

// Quadtree from the coarsest level: a tile within the next level's radius is replaced by finer ones.
std::vector<TileKey> TileScene::tiles_around(double x_m, double y_m, double margin_m) const {
  const std::array<double, kTileLevels> radius = {config_.fine_radius_m + margin_m, config_.middle_radius_m + margin_m,
                                                  config_.far_radius_m + margin_m};
  std::vector<TileKey> found;
  std::vector<TileKey> open;
  constexpr int kTop = kTileLevels - 1;
  for (int iy = tile_index(kTop, y_m - radius[kTop]); iy <= tile_index(kTop, y_m + radius[kTop]); ++iy)
    for (int ix = tile_index(kTop, x_m - radius[kTop]); ix <= tile_index(kTop, x_m + radius[kTop]); ++ix)
      if (distance({kTop, ix, iy}, x_m, y_m) < radius[kTop]) open.push_back({kTop, ix, iy});
  while (!open.empty()) {
    const TileKey key = open.back();
    open.pop_back();
    if (key.level == 0 || distance(key, x_m, y_m) >= radius[key.level - 1]) {
      found.push_back(key);
      continue;
    }
    const int ratio = static_cast<int>(std::lround(kLevels[key.level].size_m() / kLevels[key.level - 1].size_m()));
    for (int j = 0; j < ratio; ++j)
      for (int i = 0; i < ratio; ++i) open.push_back({key.level - 1, key.ix * ratio + i, key.iy * ratio + j});
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<TileKey> TileScene::height_keys_of(const TileKey& key) const {
  if (!config_.shaded) return {key};
  const Eigen::Vector2i side = sun_side(config_.appearance);
  return {key,
          {key.level, key.ix + side.x(), key.iy},
          {key.level, key.ix, key.iy + side.y()},
          {key.level, key.ix + side.x(), key.iy + side.y()}};
}

GroundTile::Heights TileScene::heights_of(const TileKey& key) const {
  const std::vector<TileKey> keys = height_keys_of(key);
  return {heights_.at(keys[0]), heights_.at(keys[1]), heights_.at(keys[2]), heights_.at(keys[3])};
}

void TileScene::build(const std::vector<TileKey>& keys) {
  std::vector<TileKey> tiles;
  for (const TileKey& key : keys)
    if (!tiles_.contains(key)) tiles.push_back(key);
  if (tiles.empty()) return;

  std::vector<TileKey> heights;
  for (const TileKey& tile : tiles) {
    for (const TileKey& key : height_keys_of(tile)) {
      if (heights_.try_emplace(key).second) heights.push_back(key);
    }
  }
  // Map nodes are inserted before the threads start; threads only assign their values.
  pool_.run(static_cast<int>(heights.size()),
            [&](int i) { heights_.at(heights[i]) = std::make_shared<const HeightTile>(heights[i], surface_); });
  for (const TileKey& key : tiles) tiles_.try_emplace(key);
  pool_.run(static_cast<int>(tiles.size()), [&](int i) {
    tiles_.at(tiles[i]) = config_.shaded ? std::make_shared<const GroundTile>(device_, heights_of(tiles[i]), surface_,
                                                                              appearance_, texture_)
                                         : std::make_shared<const GroundTile>(device_, *heights_.at(tiles[i]));
  });
}

void TileScene::prefetch_one_tile(double x_m, double y_m) {
  for (const TileKey& key : tiles_around(x_m, y_m, config_.ahead_m)) {
    if (tiles_.contains(key)) continue;
    build({key});
    return;
  }
}

void TileScene::evict_distant_tiles(double x_m, double y_m) {
  const std::array<double, kTileLevels> radius = {config_.fine_radius_m, config_.middle_radius_m, config_.far_radius_m};
  const auto far = [&](const auto& entry) {
    // Fine tiles are used in whole blocks, so a tile may exceed its radius by its parent's diagonal.
    const int parent = std::min(entry.first.level + 1, kTileLevels - 1);
    const double reach = radius[entry.first.level] + config_.keep_m + 1.5 * kLevels[parent].size_m();
    return distance(entry.first, x_m, y_m) > reach;
  };
  std::erase_if(tiles_, far);
  std::erase_if(heights_, far);
}

// Each tile is an instance translated relative to an anchor near the camera, so single precision resolves micrometres
// everywhere on the map.
void TileScene::assemble(const std::vector<TileKey>& keys) {
  shown_ = keys;
  shown_tiles_.clear();
  for (const TileKey& key : keys) shown_tiles_.push_back(tiles_.at(key));
  anchor_ = shown_tiles_.front()->origin();  // sorted by level: a fine tile
  if (scene_ != nullptr) rtcReleaseScene(scene_);
  scene_ = rtcNewScene(device_);
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
  for (size_t i = 0; i < shown_tiles_.size(); ++i) {
    const Eigen::Vector3f offset = (shown_tiles_[i]->origin() - anchor_).cast<float>();
    const float transform[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, offset.x(), offset.y(), offset.z()};
    RTCGeometry instance = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, shown_tiles_[i]->scene());
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, transform);
    rtcCommitGeometry(instance);
    rtcAttachGeometryByID(scene_, instance, static_cast<unsigned>(i));
    rtcReleaseGeometry(instance);
  }
  rtcCommitScene(scene_);
  ROVER_CHECK(rtcGetDeviceError(device_) == RTC_ERROR_NONE);
}

TileScene::View TileScene::view(const Eigen::Vector3d& p_map_eye) const {
  View view;
  view.eye = (p_map_eye - anchor_).cast<float>();
  view.camera_in_tile.reserve(shown_tiles_.size());
  for (const auto& tile : shown_tiles_) view.camera_in_tile.push_back((p_map_eye - tile->origin()).cast<float>());
  return view;
}

HitPacket TileScene::intersect(const View& view, const RayPacket& rays) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(32) static constexpr int kAll[kPacket] = {-1, -1, -1, -1, -1, -1, -1, -1};
  RTCRayHit8 traced;
  for (int k = 0; k < kPacket; ++k) {
    traced.ray.org_x[k] = view.eye.x();
    traced.ray.org_y[k] = view.eye.y();
    traced.ray.org_z[k] = view.eye.z();
    traced.ray.dir_x[k] = rays.dir_x[k];
    traced.ray.dir_y[k] = rays.dir_y[k];
    traced.ray.dir_z[k] = rays.dir_z[k];
    traced.ray.tnear[k] = 0.0F;
    traced.ray.tfar[k] = std::numeric_limits<float>::infinity();
    traced.ray.time[k] = 0.0F;
    traced.ray.mask[k] = ~0U;
    traced.ray.flags[k] = 0;
    traced.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
    traced.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
  }
  rtcIntersect8(kAll, scene_, &context, &traced);
  HitPacket hits;
  static_assert(static_cast<int>(RTC_INVALID_GEOMETRY_ID) == kNoTile);
  for (int k = 0; k < kPacket; ++k) {
    hits.tile[k] = static_cast<int>(traced.hit.instID[0][k]);
    hits.range_m[k] = traced.ray.tfar[k];
    hits.normal_x[k] = traced.hit.Ng_x[k];
    hits.normal_y[k] = traced.hit.Ng_y[k];
    hits.normal_z[k] = traced.hit.Ng_z[k];
  }
  return hits;
}

Lanes<float> TileScene::radiance(const View& view, const RayPacket& rays, const Lanes<int>& tile,
                                 const Lanes<float>& range_m, float pixel_angle_rad) const {
  GroundShader::Points points;
  for (int k = 0; k < kPacket; ++k) {
    const bool hit = tile[k] != kNoTile;
    const float range = hit ? range_m[k] : 1.0F;
    const Eigen::Vector3f& eye = view.camera_in_tile[hit ? tile[k] : 0];
    points.tile[k] = hit ? shown_tiles_[tile[k]].get() : nullptr;
    points.x[k] = eye.x() + range * rays.dir_x[k];
    points.y[k] = eye.y() + range * rays.dir_y[k];
    points.z[k] = eye.z() + range * rays.dir_z[k];
    points.pixel_m[k] = range * rays.cosine[k] * pixel_angle_rad;
  }
  return shader_.radiance(rays, points);
}

size_t TileScene::memory_bytes() const {
  size_t sum = 0;
  for (const auto& [key, tile] : tiles_) sum += tile->memory_bytes();
  for (const auto& [key, tile] : heights_) sum += tile->height.size() * sizeof(float);
  return sum;
}

}  // namespace rover
