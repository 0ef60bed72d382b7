#include "path_planner/map/view_area.hpp"

#include <gtest/gtest.h>

#include "path_planner/config.hpp"

namespace rover::planning {
namespace {

constexpr double kGroundZM = -0.6;

// A level pair of 90 degrees at the height of the body origin, pitched down.
StereoRig rig_pitched(double down_deg) {
  StereoRig rig;
  rig.width = rig.height = 410;
  rig.left = rig.right = {.fx_px = 200.0, .fy_px = 200.0, .cx_px = 205.0, .cy_px = 205.0};
  rig.T_left_right.translation().x() = 0.1;
  const double pitch = to_rad(down_deg);
  rig.T_body_left.linear().col(0) = -Eigen::Vector3d::UnitY();
  rig.T_body_left.linear().col(2) = Eigen::Vector3d(std::cos(pitch), 0.0, -std::sin(pitch));
  rig.T_body_left.linear().col(1) = rig.T_body_left.linear().col(2).cross(rig.T_body_left.linear().col(0));
  rig.T_body_left.translation().x() = 0.5;
  return rig;
}

TEST(ViewArea, IsATrapezoidAhead) {
  const ViewArea view;
  EXPECT_TRUE(view.sees({2.0, 0.0}));
  EXPECT_FALSE(view.sees({view.near_m - 0.01, 0.0}));
  EXPECT_FALSE(view.sees({view.far_m + 0.01, 0.0}));
  EXPECT_FALSE(view.sees({-2.0, 0.0}));
  for (const double side : {-1.0, 1.0}) {
    EXPECT_TRUE(view.sees({view.near_m, side * (view.near_half_width_m - 0.01)}));
    EXPECT_FALSE(view.sees({view.near_m, side * (view.near_half_width_m + 0.01)}));
    EXPECT_TRUE(view.sees({view.far_m, side * (view.far_half_width_m - 0.01)}));
    EXPECT_FALSE(view.sees({view.far_m, side * (view.far_half_width_m + 0.01)}));
  }
}

TEST(ViewArea, BeginsWhereTheLowestRayMeetsTheGround) {
  const ViewArea view = view_of(rig_pitched(0.0), kGroundZM, 4.0);
  EXPECT_NEAR(view.near_m, 0.5 + 0.6 - 0.05, 0.01);
  EXPECT_EQ(view.far_m, 4.0);
  EXPECT_EQ(view.camera.x_m, 0.5);
}

TEST(ViewArea, IsAsWideAsBothCamerasSee) {
  const ViewArea view = view_of(rig_pitched(0.0), kGroundZM, 4.0);
  EXPECT_NEAR(view.near_half_width_m, 0.6 - 0.1, 0.01) << "of the camera on the right, to the left";
  EXPECT_NEAR(view.far_half_width_m, 3.5 - 0.1, 0.01);
}

TEST(ViewArea, ACameraThatLooksUpSeesNothing) {
  EXPECT_LT(view_of(rig_pitched(-60.0), kGroundZM, 4.0).far_half_width_m, 0.0);
}

TEST(ViewArea, OfTheVehicleIsWhatThePlannerIsTestedWith) {
  const ViewArea view = load_config(ROVER_SOURCE_DIR "/config").belief.view;
  const ViewArea tested;
  EXPECT_NEAR(view.camera.x_m, tested.camera.x_m, 0.01);
  EXPECT_NEAR(view.camera.y_m, tested.camera.y_m, 0.01);
  EXPECT_NEAR(view.near_m, tested.near_m, 0.01);
  EXPECT_EQ(view.far_m, tested.far_m);
  EXPECT_NEAR(view.near_half_width_m, tested.near_half_width_m, 0.01);
  EXPECT_NEAR(view.far_half_width_m, tested.far_half_width_m, 0.05);
}

}  // namespace
}  // namespace rover::planning
