#include "global_localization/local_mosaic.hpp"

#include <algorithm>
#include <cmath>

namespace rover::global {

LocalMosaic::LocalMosaic(double side_m, double cell_m)
    : grid_(static_cast<int>(std::lround(side_m / cell_m)), cell_m, kUnseen) {}

void LocalMosaic::add(const Lattice& lattice, const std::vector<float>& values, const std::vector<float>& sigma_m,
                      const Eigen::Vector2d& p_odom_body, double max_sigma_m) {
  grid_.move_to(p_odom_body.x(), p_odom_body.y());
  if (values.empty()) return;
  for (int row = 0; row < lattice.rows; ++row)
    for (int column = 0; column < lattice.columns; ++column) {
      const size_t i = lattice.index(column, row);
      if (!std::isfinite(values[i]) || !(sigma_m[i] <= max_sigma_m)) continue;
      const CellIndex cell = grid_.index_of(lattice.center_x_m(column), lattice.center_y_m(row));
      if (grid_.contains(cell)) grid_.at(cell) = values[i];
    }
}

HeightGrid LocalMosaic::resampled(double cell_m) const {
  const double side_m = grid_.cells() * grid_.cell_m();
  HeightGrid out;
  const int cells = static_cast<int>(std::ceil(side_m / cell_m)) + 1;
  const double x0_m = grid_.origin().ix * grid_.cell_m(), y0_m = grid_.origin().iy * grid_.cell_m();
  out.lattice = {cells, cells, cell_m, std::floor(x0_m / cell_m) * cell_m, std::floor(y0_m / cell_m) * cell_m};
  std::vector<double> sum(out.lattice.size(), 0.0);
  std::vector<int> count(out.lattice.size(), 0);
  grid_.for_each([&](CellIndex cell, float z) {
    if (!std::isfinite(z)) return;
    const int column = static_cast<int>((grid_.center_x_m(cell) - out.lattice.x0_m) / cell_m);
    const int row = static_cast<int>((grid_.center_y_m(cell) - out.lattice.y0_m) / cell_m);
    if (!out.lattice.contains(column, row)) return;
    sum[out.lattice.index(column, row)] += z;
    ++count[out.lattice.index(column, row)];
  });
  const double whole = cell_m * cell_m / (grid_.cell_m() * grid_.cell_m());
  for (size_t i = 0; i < sum.size(); ++i) {
    out.z_m.push_back(count[i] > 0 ? static_cast<float>(sum[i] / count[i]) : 0.0f);
    out.weight.push_back(static_cast<float>(std::min(1.0, count[i] / whole)));
  }
  return out;
}

}  // namespace rover::global
