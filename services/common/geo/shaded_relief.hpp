// Shaded relief of terrain in the colours of Martian ground.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

namespace rover {

// A rectangle of the map frame.
struct Box {
  double x0_m = 0.0;
  double y0_m = 0.0;
  double x1_m = 0.0;
  double y1_m = 0.0;
  double width_m() const { return x1_m - x0_m; }
  double height_m() const { return y1_m - y0_m; }
  bool contains(const Eigen::Vector2d& p) const {
    return p.x() >= x0_m && p.x() <= x1_m && p.y() >= y0_m && p.y() <= y1_m;
  }
  Box expanded(double by_m) const { return {x0_m - by_m, y0_m - by_m, x1_m + by_m, y1_m + by_m}; }
};

// Heights on a raster whose lower left corner is the map frame's origin; rows from the south.
struct HeightRaster {
  int columns = 0;
  int rows = 0;
  double resolution_m = 1.0;
  std::vector<float> z_m;
  bool empty() const { return z_m.empty(); }
};

struct ReliefStyle {
  double exaggeration = 2.0;
  double smoothing_m = 0.8;         // against the map's vertical noise
  double contour_interval_m = 1.0;  // 0: none
};

// JPEG of the box at the given size in pixels.
std::vector<std::uint8_t> relief_jpeg(const HeightRaster& raster, const Box& box, int width_px, int height_px,
                                      const ReliefStyle& style);
// The same from a height function.
std::vector<std::uint8_t> relief_jpeg(const std::function<double(double, double)>& height_m, const Box& box,
                                      int width_px, int height_px, const ReliefStyle& style);

}  // namespace rover
