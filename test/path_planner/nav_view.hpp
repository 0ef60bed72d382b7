// What stereo, slam and traversability make of the NavCam's pictures in the simple world of rock_world.hpp: a map in
// odom that remembers what each view showed.
#pragma once

#include "common/core/grid_map.hpp"
#include "test/path_planner/rock_world.hpp"

namespace rover::planning::testing_support {

struct NavCameraModel {
  Point2 position{0.35, 0.0};  // in body
  double height_m = 1.1;
  double half_view_rad = 0.36;  // of both cameras together
  double near_m = 1.3;          // from the camera
  double far_m = 9.0;
};

class NavView {
 public:
  struct SeenRock : Rock {
    double shape = 0.0;  // how much of its height the map shows
  };

  explicit NavView(const NavCameraModel& camera) : camera_(camera), map_(200, 0.1, TraversabilityGrid::kUnknown) {}

  // One picture, `azimuth_rad` off the heading, seen from the true pose and laid where odometry says the rover is.
  void look(const std::vector<Rock>& rocks, const Pose2& truth, const Pose2& odom, double azimuth_rad);
  TraversabilityGrid grid(Utime utime) const;

 private:
  std::uint8_t seen(const std::vector<SeenRock>& in_body, Point2 b, double azimuth_rad) const;

  NavCameraModel camera_;
  GridMap<std::uint8_t> map_;
};

}  // namespace rover::planning::testing_support
