// The elevation maps of a run laid over each other, in odom: what the rover has seen of the ground along its way.
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
  // Of all cells ever seen, in odom.
  const Box& bounds() const { return bounds_; }
  // A map with its corner of smallest x and y, index iy * columns + ix, NaN where nothing was seen: newer over older.
  // The first map's cell size is the mosaic's; a map of another one is left out.
  void add(double cell_m, double origin_x_m, double origin_y_m, int columns, const std::vector<float>& height_m);
  // NaN where nothing was seen.
  float at(double x_m, double y_m) const;

 private:
  static constexpr int kSide = 64;  // cells
  using Tile = std::vector<float>;
  std::map<std::pair<int, int>, Tile> tiles_;
  double cell_m_ = 0.0;
  Box bounds_;
};

}  // namespace rover::report
