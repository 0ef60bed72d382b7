#include "rover_simulator/camera/hit_band.hpp"

#include <algorithm>

#include "common/core/check.hpp"

namespace rover {
namespace {

// A traced ray: direction at depth 1, and tangent plane n of the hit with n . p = 1 relative to the camera. The plane's
// inverse depth along direction d is n . d.
struct Sample {
  float dir_x, dir_y, dir_z;
  float plane_x, plane_y, plane_z;
  float inverse_depth;
  float range_m;
  int tile;

  float predict(const Sample& other) const {
    return plane_x * other.dir_x + plane_y * other.dir_y + plane_z * other.dir_z;
  }
};

class BandTracer {
 public:
  BandTracer(const TileScene& scene, const CameraView& camera, HitBand& band)
      : scene_(scene),
        camera_(camera),
        band_(band),
        width_(camera.rays.width),
        above_(static_cast<size_t>(width_ / 2 + kPacket)),
        below_(above_.size()) {}

  void run() {
    sample_row(0, below_);
    for (int row = 0; row < HitBand::kRows; row += 2) {
      std::swap(above_, below_);
      sample_row(row + 2, below_);
      for (int u = 0; u < width_; u += 2) fill_cell(u, row);
      trace_open();
    }
  }

 private:
  // Samples of a row's even pixels and one beyond its end.
  void sample_row(int row, std::vector<Sample>& samples) const {
    for (int first = 0; first <= width_ / 2; first += kPacket) {
      RayPacket rays;
      for (int k = 0; k < kPacket; ++k)
        set_viewing_ray(camera_, std::min(2 * (first + k), width_), band_.first_row + row, k, rays);
      const HitPacket hits = scene_.intersect(camera_.view, rays);
      for (int k = 0; k < kPacket; ++k) samples[first + k] = sample(rays, hits, k);
    }
  }

  static Sample sample(const RayPacket& rays, const HitPacket& hits, int k) {
    const float per_cosine = 1.0F / rays.cosine[k];
    const float along =
        hits.normal_x[k] * rays.dir_x[k] + hits.normal_y[k] * rays.dir_y[k] + hits.normal_z[k] * rays.dir_z[k];
    const float scale = 1.0F / (along * hits.range_m[k]);
    return {rays.dir_x[k] * per_cosine,
            rays.dir_y[k] * per_cosine,
            rays.dir_z[k] * per_cosine,
            hits.normal_x[k] * scale,
            hits.normal_y[k] * scale,
            hits.normal_z[k] * scale,
            per_cosine / hits.range_m[k],
            hits.range_m[k],
            hits.tile[k]};
  }

  // The pixel at (u, row), and its neighbours to the right, below and between.
  void fill_cell(int u, int row) {
    const Sample& a = above_[u / 2];
    const Sample& b = above_[u / 2 + 1];
    const Sample& c = below_[u / 2];
    const Sample& d = below_[u / 2 + 1];
    put(u, row, a.tile, a.range_m);
    if (!on_one_plane(a, b, c, d)) {
      untraced_.insert(untraced_.end(), {index(u + 1, row), index(u, row + 1), index(u + 1, row + 1)});
      return;
    }
    put_between(u + 1, row, a.tile, 0.5F * (a.inverse_depth + b.inverse_depth));
    put_between(u, row + 1, a.tile, 0.5F * (a.inverse_depth + c.inverse_depth));
    put_between(u + 1, row + 1, a.tile,
                0.25F * (a.inverse_depth + b.inverse_depth + c.inverse_depth + d.inverse_depth));
  }

  bool on_one_plane(const Sample& a, const Sample& b, const Sample& c, const Sample& d) const {
    if (a.tile == kNoTile || a.tile != b.tile || a.tile != c.tile || a.tile != d.tile) return false;
    const float limit = camera_.tolerance_per_m;
    return std::abs(a.predict(b) - b.inverse_depth) < limit && std::abs(a.predict(c) - c.inverse_depth) < limit &&
           std::abs(a.predict(d) - d.inverse_depth) < limit;
  }

  void trace_open() {
    for (size_t first = 0; first < untraced_.size(); first += kPacket) {
      RayPacket rays;
      const int count = static_cast<int>(std::min<size_t>(kPacket, untraced_.size() - first));
      for (int k = 0; k < kPacket; ++k) {
        const int at = untraced_[first + std::min(k, count - 1)];
        set_viewing_ray(camera_, at % width_, band_.first_row + at / width_, k, rays);
      }
      const HitPacket hits = scene_.intersect(camera_.view, rays);
      for (int k = 0; k < count; ++k) {
        band_.tile[untraced_[first + k]] = hits.tile[k];
        band_.range_m[untraced_[first + k]] = hits.range_m[k];
      }
    }
    untraced_.clear();
  }

  int index(int u, int row) const { return row * width_ + u; }
  void put(int u, int row, int tile, float range_m) {
    band_.tile[index(u, row)] = tile;
    band_.range_m[index(u, row)] = range_m;
  }
  void put_between(int u, int row, int tile, float inverse_depth) {
    const size_t ray = static_cast<size_t>(band_.first_row + row) * camera_.rays.stride + u;
    const float x = camera_.rays.x[ray];
    const float y = camera_.rays.y[ray];
    put(u, row, tile, std::sqrt(1.0F + x * x + y * y) / inverse_depth);
  }

  const TileScene& scene_;
  const CameraView& camera_;
  HitBand& band_;
  int width_;
  std::vector<Sample> above_, below_;
  std::vector<int> untraced_;  // pixels of the current row pair still to be traced
};

}  // namespace

HitBand find_hits(const TileScene& scene, const CameraView& camera, int first_row) {
  ROVER_CHECK(camera.rays.width % 2 == 0 && first_row + HitBand::kRows <= camera.rays.height, camera.rays.width,
              first_row);
  HitBand band;
  band.first_row = first_row;
  band.tile.resize(static_cast<size_t>(HitBand::kRows) * camera.rays.width);
  band.range_m.resize(band.tile.size());
  BandTracer(scene, camera, band).run();
  return band;
}

}  // namespace rover
