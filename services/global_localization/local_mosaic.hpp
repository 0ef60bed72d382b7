// Rolling local elevation map in odom: successive maps are inserted into a fixed-size grid that moves with the rover.
// Newer heights replace older ones.
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
  std::vector<float> sigma_m;
};

class LocalMosaic {
 public:
  LocalMosaic(double side_m, double cell_m);

  double cell_m() const { return grid_.cell_m(); }
  void clear() { grid_.clear(); }
  // Inserts the observed cells whose sigma is within the limit.
  void add(const ElevationView& view, const Eigen::Vector2d& p_odom_body, double max_sigma_m);

  // Downsamples to larger cells aligned with odom, by box averaging (anti-aliased).
  HeightGrid resampled(double cell_m) const;

 private:
  static constexpr float kUnseen = std::numeric_limits<float>::quiet_NaN();
  GridMap<float> grid_;
};

}  // namespace rover::global
