// Heights and gradients of a grid with holes: at each cell the plane that fits the seen heights around it best,
// weighted by a Gaussian. On whole ground the gradient is the derivative of the Gaussian; beside a hole it stays
// unbiased, and where too little is seen there is none. What was not seen never counts as level ground.
#pragma once

#include <cstdint>
#include <vector>

#include "global_localization/height_grid.hpp"

namespace rover::global {

struct PlaneConfig {
  double sigma_cells = 2.0;  // of the Gaussian
  double min_support = 0.5;  // of the Gaussian's weight (and of its spread along each direction) that must be seen
};

struct PlaneField {
  Lattice lattice;
  std::vector<float> z;  // at the cell's centre, over the grid's mean [m]
  std::vector<float> gx;
  std::vector<float> gy;
  std::vector<std::uint8_t> known;  // 0: the others are 0
};

PlaneField plane_field(const HeightGrid& heights, const PlaneConfig& config);

}  // namespace rover::global
