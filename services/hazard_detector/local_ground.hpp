// Natural ground bends away from the fitted plane; rocks and holes stand out of their surroundings. So limits count
// from a local ground: a low quantile of the neighbourhood's heights for obstacles, a high one for holes. How far it
// may lie from the plane is bounded, and the bound grows with the distance from the wheels, so neither a boulder nor a
// pit wider than the neighbourhood becomes ground.
#pragma once

#include <vector>

#include "hazard_detector/grid.hpp"
#include "hazard_detector/ground_plane.hpp"

namespace rover::hazard {

// Heights over the plane, one each cell.
struct LocalGround {
  std::vector<float> low_m;
  std::vector<float> high_m;
};

// `over_plane_m`: mean height of each cell over the plane, NaN where not measured.
LocalGround local_ground(const std::vector<float>& over_plane_m, const GridShape& shape, const ReliefConfig& config,
                         double wheel_line_x_m);

}  // namespace rover::hazard
