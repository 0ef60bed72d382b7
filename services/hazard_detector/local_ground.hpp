// Local ground height, because natural ground deviates from the fitted plane: a low quantile of the neighbourhood for
// obstacles, a high quantile for holes. The deviation is bounded (the bound grows with distance), so that a boulder or
// pit wider than the neighbourhood is not taken for ground.
#pragma once

#include <vector>

#include "hazard_detector/grid.hpp"
#include "hazard_detector/ground_plane.hpp"

namespace rover::hazard {

// Heights over the plane, one per cell.
struct LocalGround {
  std::vector<float> low_m;
  std::vector<float> high_m;
};

// `over_plane_m`: mean height of each cell over the plane, NaN if not measured.
LocalGround estimate_local_ground(const std::vector<float>& over_plane_m, const GridShape& shape,
                                  const LocalGroundConfig& config, double front_axle_x_m);

}  // namespace rover::hazard
