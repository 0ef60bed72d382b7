// Mosaic of a run's elevation maps in odom: all ground that the rover has observed.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "common/geo/shaded_relief.hpp"

namespace rover::report {

class ElevationMosaic {
 public:
  bool empty() const { return tiles_.empty(); }
  double cell_m() const { return cell_m_; }
  // Bounds of all observed cells, in odom.
  const Box& bounds() const { return bounds_; }
  // Inserts a map (index iy * columns + ix, NaN: unobserved; newer cells replace older ones). Other cell sizes than the
  // first are ignored.
  void add(double cell_m, double origin_x_m, double origin_y_m, int columns, const std::vector<float>& height_m);
  // NaN if unobserved.
  float at(double x_m, double y_m) const;

 private:
  static constexpr int kSide = 64;  // cells
  using Tile = std::vector<float>;
  std::map<std::pair<int, int>, Tile> tiles_;
  double cell_m_ = 0.0;
  Box bounds_;
};

}  // namespace rover::report
