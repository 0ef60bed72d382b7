// Ray-ground intersections of a band of image rows.
//
// Every second ray of every second row is traced. If four neighbours are coplanar, the rays between them are
// interpolated (inverse depth on a plane is linear in the image); otherwise they are traced.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "rover_simulator/camera/ray_table.hpp"
#include "rover_simulator/camera/tile_scene.hpp"

namespace rover {

struct CameraView {
  const RayTable& rays;
  Eigen::Matrix3f R_map_cam;
  TileScene::View view;
  float tolerance_per_m = 0.0F;  // coplanarity tolerance in inverse depth
};

struct HitBand {
  static constexpr int kRows = 32;
  int first_row = 0;
  // Row-major; see HitPacket.
  std::vector<int> tile;
  std::vector<float> range_m;
};

HitBand find_hits(const TileScene& scene, const CameraView& camera, int first_row);

// Sets lane k to the viewing ray of pixel (u, v).
inline void set_viewing_ray(const CameraView& camera, int u, int v, int k, RayPacket& rays) {
  const size_t index = static_cast<size_t>(v) * camera.rays.stride + u;
  const float x = camera.rays.x[index];
  const float y = camera.rays.y[index];
  const Eigen::Matrix3f& R = camera.R_map_cam;
  const float cosine = 1.0F / std::sqrt(1.0F + x * x + y * y);
  rays.dir_x[k] = cosine * (R(0, 0) * x + R(0, 1) * y + R(0, 2));
  rays.dir_y[k] = cosine * (R(1, 0) * x + R(1, 1) * y + R(1, 2));
  rays.dir_z[k] = cosine * (R(2, 0) * x + R(2, 1) * y + R(2, 2));
  rays.cosine[k] = cosine;
}

}  // namespace rover
