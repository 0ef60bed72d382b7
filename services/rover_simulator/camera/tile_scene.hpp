// Level-of-detail scene around the rover: fine tiles nearby, coarser ones farther away.
//
// The rendered tiles depend on the viewing position only, so images do not depend on the path taken; caching and
// prefetching only affect speed.
#pragma once

#include <embree3/rtcore.h>

#include <Eigen/Dense>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "rover_simulator/camera/ground_shader.hpp"
#include "rover_simulator/camera/ground_tile.hpp"
#include "rover_simulator/camera/ray_packet.hpp"
#include "rover_simulator/camera/worker_pool.hpp"

namespace rover {

struct TileSceneConfig {
  double fine_radius_m = 7.0;     // spacing 0.02 m within this radius
  double middle_radius_m = 18.0;  // spacing 0.1 m
  double far_radius_m = 80.0;     // spacing 0.8 m
  double ahead_m = 2.0;           // prefetch distance beyond the radii, one tile per image
  double keep_m = 3.0;            // eviction distance beyond the radii
  int threads = 2;
  bool shaded = true;  // false: only intersect() works, and tiles cost less
  GroundAppearanceConfig appearance;
};

class TileScene {
 public:
  // `surface` must outlive the scene; its functions are called from several threads.
  TileScene(const Surface& surface, const TileSceneConfig& config);
  ~TileScene();
  TileScene(const TileScene&) = delete;
  TileScene& operator=(const TileScene&) = delete;

  // Prepares the scene around the point. Not concurrently with tracing.
  void focus(double x_m, double y_m);

  // Camera position relative to scene and tiles; valid until the next focus().
  struct View {
    Eigen::Vector3f eye;                          // relative to the scene's anchor
    std::vector<Eigen::Vector3f> camera_in_tile;  // relative to each tile's origin
  };
  View view(const Eigen::Vector3d& p_map_eye) const;

  // Both are thread safe.
  HitPacket intersect(const View& view, const RayPacket& rays) const;
  // Radiance along rays that hit these tiles at these ranges. `pixel_angle_rad`: at the image centre.
  Lanes<float> radiance(const View& view, const RayPacket& rays, const Lanes<int>& tile, const Lanes<float>& range_m,
                        float pixel_angle_rad) const;

  WorkerPool& pool() { return pool_; }
  size_t tile_count() const { return tiles_.size(); }
  size_t memory_bytes() const;

 private:
  std::vector<TileKey> tiles_around(double x_m, double y_m, double margin_m) const;
  void build(const std::vector<TileKey>& keys);
  void prefetch_one_tile(double x_m, double y_m);
  GroundTile::Heights heights_of(const TileKey& key) const;
  std::vector<TileKey> height_keys_of(const TileKey& key) const;
  void evict_distant_tiles(double x_m, double y_m);
  void assemble(const std::vector<TileKey>& keys);

  const Surface& surface_;
  TileSceneConfig config_;
  GroundAppearance appearance_;
  GroundTexture texture_;
  GroundShader shader_;
  mutable WorkerPool pool_;
  RTCDevice device_;
  std::map<TileKey, std::shared_ptr<const HeightTile>> heights_;
  std::map<TileKey, std::shared_ptr<const GroundTile>> tiles_;

  RTCScene scene_ = nullptr;
  Eigen::Vector3d anchor_ = Eigen::Vector3d::Zero();
  std::vector<TileKey> shown_;
  std::vector<std::shared_ptr<const GroundTile>> shown_tiles_;  // by instance
};

}  // namespace rover
