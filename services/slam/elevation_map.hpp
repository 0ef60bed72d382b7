// The rover-centred elevation map: a Gaussian height in each cell, in a frame that the caller keeps still.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "common/core/grid_map.hpp"
#include "slam/patches.hpp"

namespace rover::slam {

struct ElevationConfig {
  int cells = 200;
  double gate_sigma = 3.5;             // an older height further off than this is contradicted
  double min_sigma_m = 0.004;          // errors that all clouds share do not average out
  double growth_m2_per_m = 4e-5;       // of the variance, by the way since the cell was last seen: relative drift
  double see_through_margin_m = 0.10;  // a ray this far below a cell's height, and 2 sigma, has gone through it
  int see_through_rays = 3;            // that many forget a cell
  double contact_m = 0.25;             // of a ray's end do not count: there the ray touches the ground
  PatchConfig patches;
};

struct ElevationCell {
  float height_m = 0.0F;      // mean
  float top_m = 0.0F;         // of the upper part where there is a step within the cell, else the same
  float variance_m2 = -1.0F;  // negative: never seen
  float seen_way_m = 0.0F;    // the rover's way when it was last seen
  std::uint8_t contradictions = 0;

  bool seen() const { return variance_m2 >= 0.0F; }
};

// Where a levelled cloud lies in the map's frame.
struct CloudPose {
  Pose2 planar;
  double z_m = 0.0;    // of the body's origin
  double way_m = 0.0;  // driven so far
};

class ElevationMap {
 public:
  explicit ElevationMap(const ElevationConfig& config)
      : config_(config), grid_(config.cells, config.patches.cell_m), gatherer_(config.patches) {}

  void clear() { grid_.clear(); }
  // The rover's place in the middle; cells that leave are forgotten.
  void move_to(double x_m, double y_m) { grid_.move_to(x_m, y_m); }
  // Forgets what the cloud sees through, then fuses it.
  void insert(const LevelCloud& cloud, const CloudPose& pose);

  const GridMap<ElevationCell>& grid() const { return grid_; }
  // Grown by the way since it was seen.
  float variance_m2(const ElevationCell& cell, double way_m) const;
  int seen_cells() const;

  // For a checkpoint: the grid lies about a corner, and every cell is put in.
  GridMap<ElevationCell>& restored_grid() { return grid_; }

 private:
  size_t scratch(CellIndex i) const;
  void note_seen(const std::vector<Patch>& patches);
  void see_through(const Eigen::Vector3f& camera_m, const std::vector<Patch>& patches, const CloudPose& pose);
  void count_ray(const Eigen::Vector3f& camera_m, const Patch& patch, const CloudPose& pose);
  float measured_variance_m2(const Patch& patch) const;
  float slope_toward(CellIndex i, int dx, int dy) const;
  void fuse(ElevationCell& cell, const Patch& patch, const CloudPose& pose) const;

  ElevationConfig config_;
  GridMap<ElevationCell> grid_;
  PatchGatherer gatherer_;
  // Of the cloud at hand, row by row from the grid's corner.
  std::vector<float> new_height_m_;   // NaN: not seen by it
  std::vector<std::uint8_t> passed_;  // rays that went through the cell
};

}  // namespace rover::slam
