// What the rover has seen of the ground of late: successive elevation maps laid into one larger grid of fixed size that
// moves with the rover, in odom. Newer heights replace older ones; memory is constant.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "common/core/grid_map.hpp"
#include "global_localization/height_grid.hpp"

namespace rover::global {

// An elevation map as it comes: NaN where never seen.
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
  // Lays in what the map has seen, around the rover. Cells with a sigma above the limit are not taken.
  void add(const ElevationView& view, const Eigen::Vector2d& p_odom_body, double max_sigma_m);

  // Means over larger cells (anti-aliased), aligned with odom; weight: share of each that was seen.
  HeightGrid resampled(double cell_m) const;

 private:
  static constexpr float kUnseen = std::numeric_limits<float>::quiet_NaN();
  GridMap<float> grid_;
};

}  // namespace rover::global
