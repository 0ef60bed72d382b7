// Bilinear interpolation of the elevation map for the scan matcher: height, slope and variance.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <vector>

#include "slam/elevation_map.hpp"

namespace rover::slam {

class MatchSurface {
 public:
  // Coordinates are relative to the grid's corner [cells], heights relative to `z_m`.
  MatchSurface(const ElevationMap& map, double z_m, double travelled_m);

  struct Sample {
    float height_m;
    float slope_x, slope_y;
    float variance_m2;
  };
  std::optional<Sample> sample(float x, float y) const;

  // NaN if one of the four surrounding cells was never seen.
  float height(float x, float y) const {
    const float u = x - 0.5F, v = y - 0.5F;
    if (!(u >= 0.0F && v >= 0.0F && u < limit_ && v < limit_)) return std::numeric_limits<float>::quiet_NaN();
    const int i = static_cast<int>(u), j = static_cast<int>(v);
    const float a = u - static_cast<float>(i), b = v - static_cast<float>(j);
    const float* at = height_m_.data() + static_cast<size_t>(j) * cells_ + i;
    const float low = at[0] + a * (at[1] - at[0]), high = at[cells_] + a * (at[cells_ + 1] - at[cells_]);
    return low + b * (high - low);
  }

  double cell_m() const { return cell_m_; }
  // Position of the corner in the map's frame.
  double corner_x_m() const { return corner_.ix * cell_m_; }
  double corner_y_m() const { return corner_.iy * cell_m_; }

 private:
  int cells_;
  double cell_m_;
  float limit_;
  CellIndex corner_;
  std::vector<float> height_m_, variance_m2_;
};

}  // namespace rover::slam
