// Test fixture: detects hazards in a synthetic world seen by the ideal LocCam, with queries on the resulting map.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/core/frames.hpp"
#include "hazard_detector/hazard_detector.hpp"
#include "test/hazard_detector/noise_field.hpp"
#include "test/stereo/synthetic_world.hpp"

namespace rover::hazard {

// Ground sloped by the angles (positive pitch: falls away ahead) that passes under the front wheels.
inline synthetic::World sloped(double pitch_deg, double roll_deg = 0.0) {
  synthetic::World world;
  world.slope_x = -std::tan(to_rad(pitch_deg));
  world.slope_y = std::tan(to_rad(roll_deg));
  world.z0_m -= 0.75 * world.slope_x;
  return world;
}

// Flat ground under a body pitched about its origin.
inline synthetic::World under_pitched_body(double pitch_deg) {
  synthetic::World world;
  world.slope_x = -std::tan(to_rad(pitch_deg));
  return world;
}

struct Map {
  const GridShape& shape;
  const HazardResult& result;

  Cell at(double x_m, double y_m) const {
    const int ix = static_cast<int>(std::floor((x_m - shape.origin_x_m) / shape.cell_m));
    const int iy = static_cast<int>(std::floor((y_m - shape.origin_y_m) / shape.cell_m));
    return shape.contains(ix, iy) ? result.cells[static_cast<size_t>(shape.at(ix, iy))] : Cell::kUnseen;
  }
  int count(Cell state) const { return static_cast<int>(std::count(result.cells.begin(), result.cells.end(), state)); }
  int hazards() const { return static_cast<int>(std::count_if(result.cells.begin(), result.cells.end(), is_hazard)); }
  // Number of cells that fulfil the condition, with their centre within distance_m of a point.
  template <class F>
  int count_near(F&& fulfils, double x_m, double y_m, double distance_m) const {
    int n = 0;
    for (int iy = 0; iy < shape.cells_y; ++iy)
      for (int ix = 0; ix < shape.cells_x; ++ix)
        n += std::hypot(shape.x_m(ix) - x_m, shape.y_m(iy) - y_m) < distance_m &&
             fulfils(result.cells[static_cast<size_t>(shape.at(ix, iy))]);
    return n;
  }
  int count_near(Cell state, double x_m, double y_m, double distance_m) const {
    return count_near([state](Cell cell) { return cell == state; }, x_m, y_m, distance_m);
  }
};

class SceneTest : public testing::Test {
 protected:
  HazardResult detect(const synthetic::World& world, double sigma_px = 0.2, double drop = 0.05) {
    return detector_.step(noise_.apply(synthetic::exact_disparity(world, camera_), camera_, sigma_px, drop), camera_);
  }
  Map map(const HazardResult& result) const { return {detector_.shape(), result}; }

  StereoCamera camera_ = synthetic::loccam_camera();
  HazardDetector detector_{HazardConfig{}};
  synthetic::NoiseField noise_{1};
};

}  // namespace rover::hazard
