// Scenes of the tests: ground with upright cylinders, and pits where their height is negative.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/core/frames.hpp"
#include "rover_simulator/world/surface.hpp"
#include "tools/truth_perception/line_of_sight.hpp"

namespace rover::truth {

inline constexpr double kCellM = 0.1;

struct Block {
  double x_m, y_m, radius_m, height_m;
};

struct Blocks : Surface {
  std::vector<Block> blocks;
  double slope_x = 0.0;

  double height_m(double x_m, double y_m) const override {
    double top_m = 0.0;
    for (const Block& b : blocks)
      if (std::hypot(x_m - b.x_m, y_m - b.y_m) <= b.radius_m)
        top_m = b.height_m < 0.0 ? b.height_m : std::max(top_m, b.height_m);
    return slope_x * x_m + top_m;
  }
  Material material(double, double) const override { return {}; }
};

// True if the cell's square about (x, y) touches the block.
inline bool touches(const Block& block, double x_m, double y_m, double cell_m) {
  const double dx = std::max(0.0, std::abs(x_m - block.x_m) - 0.5 * cell_m);
  const double dy = std::max(0.0, std::abs(y_m - block.y_m) - 0.5 * cell_m);
  return std::hypot(dx, dy) <= block.radius_m;
}

// The NavCam 1.1 m above the ground, looking along x.
inline View navcam_at(double x_m, double y_m, double ground_m) {
  View view;
  view.camera = {.width = 640, .height = 480, .focal_px = 818.0, .cx_px = 320.0, .cy_px = 240.0, .baseline_m = 0.24};
  view.T_map_cam = make_pose(camera_rotation(to_rad(17.0)), Eigen::Vector3d(x_m, y_m, ground_m + 1.1));
  view.min_depth_m = 0.8;
  return view;
}

}  // namespace rover::truth
