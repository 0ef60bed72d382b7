#include "common/core/frames.hpp"

#include <gtest/gtest.h>

namespace rover {
namespace {

TEST(Frames, RollPitchYawGoThereAndBack) {
  for (double roll : {-1.0, 0.0, 0.4})
    for (double pitch : {-1.2, 0.0, 0.7})
      for (double yaw : {-3.0, 0.0, 2.5}) {
        const Eigen::Vector3d rpy = rpy_of(rotation_from_rpy(roll, pitch, yaw));
        EXPECT_NEAR(rpy.x(), roll, 1e-12);
        EXPECT_NEAR(rpy.y(), pitch, 1e-12);
        EXPECT_NEAR(rpy.z(), yaw, 1e-12);
      }
}

TEST(Frames, PositivePitchLooksDown) {
  EXPECT_LT((rotation_from_rpy(0.0, 0.3, 0.0) * Eigen::Vector3d::UnitX()).z(), 0.0);
}

TEST(Frames, CameraLooksForwardAndDown) {
  const Eigen::Matrix3d R_body_cam = camera_rotation(to_rad(33.0));
  const Eigen::Vector3d forward = R_body_cam * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(forward.x(), std::cos(to_rad(33.0)), 1e-12);
  EXPECT_NEAR(forward.z(), -std::sin(to_rad(33.0)), 1e-12);
  EXPECT_NEAR((R_body_cam * Eigen::Vector3d::UnitX()).y(), -1.0, 1e-12);
}

// Rolled to the right the origin leans to the right of the ground point.
TEST(Frames, GroundPointStaysUnderTheWheelsOnASideSlope) {
  const Eigen::Isometry3d T = make_pose(rotation_from_rpy(to_rad(15.0), 0.0, 0.0), {3.0, 2.0, 1.0});
  EXPECT_NEAR(planar(ground_pose(T, 0.62)).y_m, 2.0 + 0.16, 0.001);
  EXPECT_NEAR(planar(ground_pose(T, 0.62)).x_m, 3.0, 1e-9);
}

TEST(Frames, ExpAndLogAreInverse) {
  for (const Eigen::Vector3d& w :
       {Eigen::Vector3d(0.1, -0.2, 0.3), Eigen::Vector3d(0, 0, 3.0), Eigen::Vector3d(0, 0, 0)})
    EXPECT_LT((log_so3(exp_so3(w)) - w).norm(), 1e-9);
}

TEST(Frames, WrapKeepsTheAngleInOneTurn) {
  for (double angle = -20.0; angle < 20.0; angle += 0.37) {
    const double wrapped = wrap_angle(angle);
    EXPECT_GT(wrapped, -kPi);
    EXPECT_LE(wrapped, kPi);
    EXPECT_NEAR(std::cos(wrapped), std::cos(angle), 1e-9);
    EXPECT_NEAR(std::sin(wrapped), std::sin(angle), 1e-9);
  }
}

TEST(Frames, InterpolationMeetsItsEnds) {
  const Eigen::Isometry3d a = from_planar({1.0, 2.0, 0.3});
  const Eigen::Isometry3d b = from_planar({2.0, 0.0, 1.3});
  EXPECT_TRUE(interpolate(a, b, 0.0).isApprox(a, 1e-12));
  EXPECT_TRUE(interpolate(a, b, 1.0).isApprox(b, 1e-12));
  EXPECT_NEAR(yaw_of(interpolate(a, b, 0.5)), 0.8, 1e-12);
}

TEST(Frames, NanIsSeen) {
  EXPECT_FALSE(is_finite(nan_pose()));
}

}  // namespace
}  // namespace rover
