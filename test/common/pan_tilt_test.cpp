#include "common/core/pan_tilt.hpp"

#include <gtest/gtest.h>

namespace rover {
namespace {

const PanTiltUnit kUnit{.p_body_axes = {0.4, 0.0, 0.4}, .pan_max_rad = 2.0, .tilt_min_rad = -0.3, .tilt_max_rad = 0.8};
// Looks ahead and 0.3 rad down, 0.1 m left of the axes.
const Eigen::Isometry3d kMount = make_pose(camera_rotation(0.3), {0.4, 0.1, 0.45});

Eigen::Vector3d forward(const Eigen::Isometry3d& T_body_cam) {
  return T_body_cam.linear() * Eigen::Vector3d::UnitZ();
}

TEST(PanTilt, AtZeroTheCameraIsAtItsMount) {
  EXPECT_TRUE(T_body_navcam(kUnit, kMount, 0.0, 0.0).isApprox(kMount, 1e-12));
}

TEST(PanTilt, PanTurnsToTheLeftAboutTheAxis) {
  const Eigen::Isometry3d T = T_body_navcam(kUnit, kMount, 0.5 * kPi, 0.0);
  EXPECT_TRUE(T.translation().isApprox(Eigen::Vector3d(0.3, 0.0, 0.45), 1e-12));
  EXPECT_TRUE(forward(T).isApprox(Eigen::Vector3d(0.0, std::cos(0.3), -std::sin(0.3)), 1e-12));
}

TEST(PanTilt, TiltLooksDownWhereverItIsPanned) {
  for (const double pan : {-1.2, 0.0, 0.7}) {
    const Eigen::Vector3d axis = forward(T_body_navcam(kUnit, kMount, pan, 0.4));
    EXPECT_NEAR(axis.z(), -std::sin(0.7), 1e-12);
    EXPECT_NEAR(std::atan2(axis.y(), axis.x()), pan, 1e-12);
  }
}

TEST(PanTilt, LimitsClamp) {
  EXPECT_EQ(kUnit.clamp_pan(-3.0), -2.0);
  EXPECT_EQ(kUnit.clamp_tilt(1.0), 0.8);
  EXPECT_EQ(kUnit.clamp_tilt(-1.0), -0.3);
}

}  // namespace
}  // namespace rover
