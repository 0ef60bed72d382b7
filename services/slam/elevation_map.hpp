// Robot-centric elevation map: one Gaussian height per cell (Fankhauser et al. 2014). Its frame is fixed; the window
// of cells follows the rover.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "common/core/grid_map.hpp"
#include "slam/patches.hpp"

namespace rover::slam {

struct ElevationConfig {
  int cells = 200;
  double gate_sigma = 3.5;          // innovation gate: beyond it a measurement is an outlier
  double min_sigma_m = 0.004;       // floor: errors common to all clouds do not average out
  double growth_m2_per_m = 4e-5;    // process noise per metre driven since the cell was last seen (drift)
  double clearing_margin_m = 0.10;  // a ray this far and 2 sigma below a cell's height passed through it
  int clearing_rays = 3;            // so many rays through a cell clear it
  double ray_end_margin_m = 0.25;   // no clearing in the last part of a ray, where it touches the ground
  PatchConfig patches;
};

struct ElevationCell {
  float height_m = 0.0F;      // mean
  float top_m = 0.0F;         // upper part of a step inside the cell, else equal to height_m
  float variance_m2 = -1.0F;  // negative: never seen
  float seen_at_m = 0.0F;     // distance driven when the cell was last seen
  std::uint8_t outliers = 0;  // measurements in a row that failed the gate
  float brightness = kNoBrightness;

  bool seen() const { return variance_m2 >= 0.0F; }
};

// Pose of a gravity-aligned cloud in the map's frame.
struct CloudPose {
  Pose2 planar;
  double z_m = 0.0;          // of the body's origin
  double travelled_m = 0.0;  // driven so far
};

class ElevationMap {
 public:
  explicit ElevationMap(const ElevationConfig& config)
      : config_(config), grid_(config.cells, config.patches.cell_m), binner_(config.patches) {}

  void clear() { grid_.clear(); }
  // Centres the map on the rover; cells that leave it are dropped.
  void move_to(double x_m, double y_m) { grid_.move_to(x_m, y_m); }
  // Clears cells that the cloud's rays pass through, then fuses the cloud.
  void insert(const AlignedCloud& cloud, const CloudPose& pose);

  const GridMap<ElevationCell>& grid() const { return grid_; }
  // Includes the growth since the cell was last seen.
  float variance_m2(const ElevationCell& cell, double travelled_m) const;
  int seen_cells() const;

  // For restoring a checkpoint.
  GridMap<ElevationCell>& mutable_grid() { return grid_; }

 private:
  size_t cell_offset(CellIndex i) const;
  void store_cloud_heights(const std::vector<Patch>& patches);
  void clear_along_rays(const Eigen::Vector3f& camera_m, const std::vector<Patch>& patches, const CloudPose& pose);
  void trace_ray(const Eigen::Vector3f& camera_m, const Patch& patch, const CloudPose& pose);
  float measured_variance_m2(const Patch& patch) const;
  float slope_along(CellIndex i, int dx, int dy) const;
  void fuse(ElevationCell& cell, const Patch& patch, const CloudPose& pose) const;

  ElevationConfig config_;
  GridMap<ElevationCell> grid_;
  PatchBinner binner_;
  // Of the current cloud, row by row from the grid's corner.
  std::vector<float> new_height_m_;         // NaN: not seen
  std::vector<std::uint8_t> rays_through_;  // number of rays through each cell
};

}  // namespace rover::slam
