// Least-squares plane over a disc around each cell. Prefix sums per row make the cost of a disc proportional to its
// rows; loops along rows vectorise.
#pragma once

#include <cstdint>
#include <vector>

#include "traversability/terrain_grid.hpp"
#include "traversability/traversability_config.hpp"

namespace rover::trav {

// Plane of one cell's disc; NaN with too few cells.
struct DiscPlane {
  float slope_x = 0.0F;  // along odom's axes
  float slope_y = 0.0F;
  float height_m = 0.0F;  // of the plane at the cell's centre
  float rms_m = 0.0F;     // residual about the plane
};

class DiscPlanes {
 public:
  DiscPlanes(const GridShape& shape, const PlaneConfig& config);

  // `mask`: 1 for each cell to fit, whose height must be finite, else 0.
  void fit(const std::vector<float>& height_m, const std::vector<std::uint8_t>& mask);
  // As fit(), but discs with too few cells keep their previous plane.
  void refit(const std::vector<float>& height_m, const std::vector<std::uint8_t>& mask);

  const DiscPlane& at(std::size_t cell) const { return planes_[cell]; }
  // Number of cells fitted.
  int count(std::size_t cell) const { return count_[cell]; }

 private:
  static constexpr int kMoments = 6;  // per row: 1, x, x^2, z, x z, z^2
  static constexpr int kSums = 10;    // per disc: also y, y^2, x y, y z

  void sum_rows(const std::vector<float>& height_m, const std::vector<std::uint8_t>& mask, double datum_m);
  void sum_discs(int iy);
  void add_row(int iy, int moment, int sum, double factor, int dy);
  void solve(int iy, double datum_m);
  const double* row(int iy, int moment) const;

  GridShape shape_;
  PlaneConfig config_;
  int reach_;                 // radius of the disc in cells
  std::vector<int> half_;     // half width of the disc in each of its rows
  std::size_t stride_;        // of a row of prefix sums, padded on both sides
  int min_cells_ = 0;         // for a plane
  std::vector<double> rows_;  // prefix sums along each row
  std::vector<double> sums_;  // of all discs in one row of cells
  std::vector<DiscPlane> planes_;
  std::vector<int> count_;
};

}  // namespace rover::trav
