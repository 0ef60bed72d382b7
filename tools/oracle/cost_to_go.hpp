// The region of a search, and the 2-D cost-to-go in it: the length of the shortest line to the goal on which the rover
// fits at one heading at least.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "tools/oracle/footprint_check.hpp"

namespace rover::oracle {

using Points = std::vector<Eigen::Vector2d>;

struct Region {
  double x0_m = 0.0;
  double y0_m = 0.0;
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> inside;

  static constexpr double kCellM = 0.1;
  // -1: outside.
  int cell(double x_m, double y_m) const {
    const int x = static_cast<int>(std::floor((x_m - x0_m) / kCellM));
    const int y = static_cast<int>(std::floor((y_m - y0_m) / kCellM));
    return x >= 0 && y >= 0 && x < width && y < height && inside[static_cast<size_t>(y) * width + x] ? y * width + x
                                                                                                     : -1;
  }
  double x_m(int cell) const { return x0_m + (cell % width + 0.5) * kCellM; }
  double y_m(int cell) const { return y0_m + (cell / width + 0.5) * kCellM; }
};

// Ground on the map within this distance of the line.
Region region_around(const Points& line, double half_width_m, double map_width_m, double map_length_m);

class CostToGo {
 public:
  CostToGo(const Region& region, const FootprintCheck& check, const Eigen::Vector2d& goal, double tolerance_m,
           double start_yaw_rad);

  // Infinity: no line leads to the goal.
  double at(double x_m, double y_m) const {
    const int cell = region_.cell(x_m, y_m);
    return cell < 0 ? kInfinity : metres_[static_cast<size_t>(cell)];
  }

 private:
  const Region& region_;
  std::vector<double> metres_;
};

}  // namespace rover::oracle
