// Smoothed heights and gradients of a grid with holes: Gaussian-weighted least-squares plane at each cell. Without
// holes the gradient equals the derivative of Gaussian; beside a hole it remains unbiased.
#pragma once

#include <cstdint>
#include <vector>

#include "global_localization/height_grid.hpp"

namespace rover::global {

struct PlaneConfig {
  double sigma_cells = 1.5;  // Gaussian standard deviation
  double min_support = 0.5;  // minimum observed fraction of the Gaussian's weight, and of its spread along each axis
};

struct PlaneField {
  Lattice lattice;
  std::vector<float> z;  // at the cell's centre, relative to the grid's mean [m]
  std::vector<float> gx;
  std::vector<float> gy;
  std::vector<std::uint8_t> known;  // 0: too little support, the other fields are 0
};

PlaneField plane_field(const HeightGrid& heights, const PlaneConfig& config);

}  // namespace rover::global
