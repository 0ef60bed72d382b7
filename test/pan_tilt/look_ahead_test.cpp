#include "pan_tilt/look_ahead.hpp"

#include <gtest/gtest.h>

#include "pan_tilt/sweep.hpp"

namespace rover::gaze {
namespace {

const CameraMount kMount{.height_m = 1.1, .pitch_down_rad = to_rad(17.0), .pan_axis_x_m = 0.4};

TEST(PointAhead, IsMeasuredAlongThePathFromTheNearestPoint) {
  const Path corner = {{0.0, 0.0}, {4.0, 0.0}, {4.0, 10.0}};
  EXPECT_TRUE(lookahead_point(corner, {1.0, 0.3}, 2.0).isApprox(Eigen::Vector2d(3.0, 0.0)));
  EXPECT_TRUE(lookahead_point(corner, {2.0, -0.5}, 4.0).isApprox(Eigen::Vector2d(4.0, 2.0)));
  EXPECT_TRUE(lookahead_point(corner, {3.9, 9.0}, 4.0).isApprox(Eigen::Vector2d(4.0, 10.0)));
  const Path twice = {{1.0, 1.0}, {1.0, 1.0}};
  EXPECT_TRUE(lookahead_point(twice, {0.0, 0.0}, 4.0).isApprox(Eigen::Vector2d(1.0, 1.0)));
}

TEST(LookAhead, PansIntoTheBendUpToThePanLimit) {
  const Path left = {{0.0, 0.0}, {2.0, 0.0}, {2.0, 10.0}};
  const Gaze gaze = look_ahead(left, {0.0, 0.0, 0.0}, kMount, {});
  EXPECT_NEAR(gaze.pan_rad, std::atan2(2.0, 1.6), 1e-9);
  // Invariant to the rover's pose.
  const Pose2 body{5.0, -3.0, 2.5};
  Path moved;
  for (const Eigen::Vector2d& p : left)
    moved.push_back(Eigen::Rotation2Dd(body.yaw_rad) * p + Eigen::Vector2d(body.x_m, body.y_m));
  EXPECT_NEAR(look_ahead(moved, body, kMount, {}).pan_rad, gaze.pan_rad, 1e-9);
  const Path back = {{0.0, 0.0}, {0.0, -10.0}};
  EXPECT_DOUBLE_EQ(look_ahead(back, {0.0, 0.0, 0.0}, kMount, {}).pan_rad, -to_rad(60.0));
}

TEST(LookAhead, TiltKeepsNearAndFarGroundInTheImage) {
  const Gaze gaze = look_ahead({}, {}, kMount, {});
  EXPECT_EQ(gaze.pan_rad, 0.0);
  constexpr double kHalfView = to_rad(16.3);
  const double centre = kMount.pitch_down_rad + gaze.tilt_rad;
  EXPECT_LT(std::atan2(1.1, 2.0), centre + kHalfView);
  EXPECT_GT(std::atan2(1.1, 8.0), centre - kHalfView);
}

TEST(Sweep, CoversAllAzimuthsFromNearToFar) {
  const std::vector<Gaze> views = sweep_views({});
  ASSERT_EQ(views.size(), 10u);
  EXPECT_EQ(views.front().pan_rad, 0.0);
  // Half of the NavCam's 43 x 33 deg; 3 deg less pan where the views of both cameras do not overlap.
  const auto seen = [&](double azimuth_deg, double distance_m) {
    return std::any_of(views.begin(), views.end(), [&](const Gaze& view) {
      const double down = std::atan2(1.1, distance_m) - kMount.pitch_down_rad - view.tilt_rad;
      return std::abs(to_rad(azimuth_deg) - view.pan_rad) < to_rad(18.0) && std::abs(down) < to_rad(16.3);
    });
  };
  for (double azimuth = -75.0; azimuth <= 75.0; azimuth += 5.0)
    for (double distance = 0.75; distance <= 10.0; distance += 0.25)
      EXPECT_TRUE(seen(azimuth, distance)) << azimuth << " " << distance;
}

}  // namespace
}  // namespace rover::gaze
