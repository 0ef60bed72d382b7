// Rolling local map in odom, of heights or of brightness: successive maps are inserted into a fixed-size grid that
// moves with the rover. Newer values replace older ones.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "common/core/grid_map.hpp"
#include "global_localization/height_grid.hpp"

namespace rover::global {

// One input elevation map; NaN marks unobserved cells.
struct ElevationView {
  Lattice lattice;
  std::vector<float> z_m;
  std::vector<float> sigma_m;     // of z_m
  std::vector<float> brightness;  // of the ground; empty or NaN: none
};

class LocalMosaic {
 public:
  LocalMosaic(double side_m, double cell_m);

  double cell_m() const { return grid_.cell_m(); }
  void clear() { grid_.clear(); }
  // Inserts the finite values whose cell's height has a sigma within the limit. No values: none.
  void add(const Lattice& lattice, const std::vector<float>& values, const std::vector<float>& sigma_m,
           const Eigen::Vector2d& p_odom_body, double max_sigma_m);

  // Downsamples to larger cells aligned with odom, by box averaging (anti-aliased).
  HeightGrid resampled(double cell_m) const;

 private:
  static constexpr float kUnseen = std::numeric_limits<float>::quiet_NaN();
  GridMap<float> grid_;
};

}  // namespace rover::global
