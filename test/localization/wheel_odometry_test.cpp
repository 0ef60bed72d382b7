#include "localization/wheel_odometry.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "synthetic_drive.hpp"

namespace rover::loc {
namespace {

constexpr std::array<double, 4> kStraight = {0.0, 0.0, 0.0, 0.0};

TEST(WheelOdometry, StraightDrive) {
  const WheelOdometry wheels(test_vehicle());
  const Eigen::Vector3d motion = wheels.body_motion({2, 2, 2, 2, 2, 2}, kStraight);
  EXPECT_NEAR(motion.x(), 0.25, 1e-12);
  EXPECT_NEAR(motion.y(), 0.0, 1e-12);
  EXPECT_NEAR(motion.z(), 0.0, 1e-12);
  EXPECT_NEAR(wheels.path_m({2, -2, 2, -2, 2, -2}), 0.25, 1e-12);
}

// With wheels steered for the motion.
TEST(WheelOdometry, ForwardInvertsInverseKinematics) {
  const Vehicle v = test_vehicle();
  const WheelOdometry wheels(v);
  for (const Eigen::Vector3d& motion : {Eigen::Vector3d(0.1, 0.0, 0.05), Eigen::Vector3d(-0.1, 0.0, 0.03),
                                        Eigen::Vector3d(0.0, 0.0, 0.2), Eigen::Vector3d(0.1, 0.0, -0.1)}) {
    std::array<double, 4> steer{};
    for (size_t i = 0; i < 4; ++i) {
      const auto w = static_cast<size_t>(kSteeredWheels[i]);
      steer[i] = std::atan2(motion.z() * v.wheel_x_m[w], motion.x() - motion.z() * v.wheel_y_m[w]);
    }
    std::array<double, 6> turned = wheels.wheel_travel_m(motion, steer);
    for (double& t : turned) t /= v.wheel_radius_m;
    EXPECT_LT((wheels.body_motion(turned, steer) - motion).norm(), 1e-12) << motion.transpose();
  }
}

}  // namespace
}  // namespace rover::loc
