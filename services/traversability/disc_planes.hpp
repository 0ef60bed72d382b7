// Least-squares planes over a disc around each cell, of those cells that count. Sums along each row are made once, so a
// disc costs its rows, not its cells; the loops run along rows and vectorise.
#pragma once

#include <cstdint>
#include <vector>

#include "traversability/terrain_grid.hpp"
#include "traversability/traversability_config.hpp"

namespace rover::trav {

// Of one cell's disc; NaN where there is too little ground for a plane.
struct DiscPlane {
  float slope_x = 0.0F;  // rise over run along odom's axes
  float slope_y = 0.0F;
  float height_m = 0.0F;  // of the plane at the cell's centre
  float rms_m = 0.0F;     // of the ground about the plane
};

class DiscPlanes {
 public:
  DiscPlanes(const GridShape& shape, const PlaneConfig& config);

  // `counts`: 1 for each cell of finite height that is to be fitted, else 0.
  void fit(const std::vector<float>& height_m, const std::vector<std::uint8_t>& counts);
  // As fit, but a disc that has too few such cells keeps its plane.
  void fit_again(const std::vector<float>& height_m, const std::vector<std::uint8_t>& counts);

  const DiscPlane& at(std::size_t cell) const { return planes_[cell]; }
  // Cells in the disc that counted.
  int count(std::size_t cell) const { return count_[cell]; }

 private:
  static constexpr int kMoments = 6;  // of a row: 1, x, x^2, z, x z, z^2
  static constexpr int kSums = 10;    // of a disc: those, and y, y^2, x y, y z

  void sum_rows(const std::vector<float>& height_m, const std::vector<std::uint8_t>& counts, double datum_m);
  void sum_discs(int iy);
  void add_row(int iy, int moment, int sum, double factor, int dy);
  void solve(int iy, double datum_m);
  const double* row(int iy, int moment) const;

  GridShape shape_;
  PlaneConfig config_;
  int reach_;                 // of the disc, in cells
  std::vector<int> half_;     // half width of the disc in each of its rows
  std::size_t stride_;        // of a row of sums, with a margin on both sides
  int least_ = 0;             // cells for a plane
  std::vector<double> rows_;  // running sums along each row
  std::vector<double> sums_;  // of the discs of one row of cells
  std::vector<DiscPlane> planes_;
  std::vector<int> count_;
};

}  // namespace rover::trav
