#include "tools/truth_perception/true_surface.hpp"

#include <gtest/gtest.h>

#include "test/truth_perception/scene.hpp"
#include "tools/truth_perception/line_of_sight.hpp"

namespace rover::truth {
namespace {

class Wavy : public Surface {
 public:
  double height_m(double x_m, double y_m) const override { return 0.3 * std::sin(x_m) + 0.2 * std::cos(1.3 * y_m); }
  Material material(double, double) const override { return {}; }
};

TEST(TrueSurfaceTest, InterpolatesTheSurfaceOnBothSidesOfTheOriginAndAfterEviction) {
  const Wavy wavy;
  TrueSurface surface(wavy);
  for (int pass = 0; pass < 2; ++pass)
    for (int i = -60; i < 60; ++i)
      for (int j = -30; j < 30; ++j) {
        const double x = 0.517 * i, y = 1.013 * j;
        ASSERT_NEAR(surface.height_m(x, y), wavy.height_m(x, y), 1e-4) << x << " " << y;
      }
}

TEST(TrueSurfaceTest, TopIsTheHighestPointOfTheCell) {
  Blocks world;
  world.blocks = {{1.05, 2.05, 0.03, 0.4}};
  TrueSurface surface(world);
  EXPECT_NEAR(surface.top_m(1.0, 2.0, 0.1), 0.4, 1e-6);
  EXPECT_NEAR(surface.top_m(1.1, 2.0, 0.1), 0.0, 1e-6);
}

// A camera 1 m above ground looks along y, down by 45 deg.
View looking_along_y(double max_depth_m) {
  View view;
  view.camera = {.width = 401, .height = 401, .focal_px = 400.0, .cx_px = 200.0, .cy_px = 200.0, .baseline_m = 0.1};
  const Eigen::Vector3d axis = Eigen::Vector3d(0.0, 1.0, -1.0).normalized();
  view.T_map_cam.linear().col(0) = Eigen::Vector3d::UnitX();
  view.T_map_cam.linear().col(1) = axis.cross(Eigen::Vector3d::UnitX());
  view.T_map_cam.linear().col(2) = axis;
  view.T_map_cam.translation() = Eigen::Vector3d(5.0, 3.0, 1.0);
  view.max_depth_m = max_depth_m;
  return view;
}

TEST(LineOfSightTest, ViewIsWhatBothImagesShow) {
  Blocks world;
  TrueSurface surface(world);
  double nearest = 1e9, farthest = 0.0, left = 0.0, right = 0.0;
  std::vector<SurfacePoint> points;
  find_points_in_view(surface, looking_along_y(2.0), points);
  for (const SurfacePoint& point : points) {
    EXPECT_TRUE(point.visible);
    const double ahead = point.p_map.y() - 3.0, aside = point.p_map.x() - 5.0;
    nearest = std::min(nearest, ahead);
    farthest = std::max(farthest, ahead);
    if (std::abs(ahead - 1.0) > 0.02) continue;
    left = std::max(left, -aside);
    right = std::max(right, aside);
  }
  EXPECT_NEAR(nearest, 1.0 / 3.0, 0.03);  // 71.6 deg down
  EXPECT_NEAR(farthest, 2.0 * std::sqrt(2.0) - 1.0, 0.03);
  EXPECT_NEAR(right, 0.5 * std::sqrt(2.0), 0.03);
  EXPECT_NEAR(left, 0.5 * std::sqrt(2.0) - 0.1, 0.03);  // the right camera sees less by the baseline
}

TEST(LineOfSightTest, ShadowOfABlockEndsWhereTheRayOverItsTopMeetsTheGround) {
  Blocks world;
  world.blocks = {{5.0, 4.5, 0.3, 0.2}};
  TrueSurface surface(world);
  int hidden = 0, seen = 0;
  std::vector<SurfacePoint> points;
  find_points_in_view(surface, looking_along_y(6.0), points);
  for (const SurfacePoint& point : points) {
    if (std::abs(point.p_map.x() - 5.0) > 0.05) continue;
    const double ahead = point.p_map.y() - 3.0;
    // The rear edge of the top is 1.8 m ahead and 0.8 m below the camera.
    const bool in_shadow = ahead > 1.84 && ahead < 2.2, clear = ahead < 1.16 || ahead > 2.3;
    hidden += in_shadow;
    seen += clear;
    if (in_shadow || clear) {
      EXPECT_EQ(point.visible, clear) << ahead;
    }
  }
  EXPECT_GT(hidden, 50);
  EXPECT_GT(seen, 50);
}

}  // namespace
}  // namespace rover::truth
