#include "localization/inputs.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace rover::loc {
namespace {

ImuSample imu() {
  ImuSample s;
  s.utime = 20'000;
  s.dt_s = 0.02;
  s.delta_velocity_mps.z() = 0.0742;
  return s;
}

VisualMotion visual() {
  VisualMotion m;
  m.utime = 800'000;
  m.previous_utime = 400'000;
  m.keyframe_utime = 400'000;
  m.T_prev_cur = Eigen::Isometry3d::Identity();
  m.cov = Matrix6d::Identity() * 1e-6;
  m.status = VisualStatus::kOk;
  return m;
}

TEST(Inputs, ValidInputsPass) {
  EXPECT_EQ(validation_error(imu()), "");
  EXPECT_EQ(validation_error(WheelSample{}), "");
  EXPECT_EQ(validation_error(WheelCommand{}), "");
  EXPECT_EQ(validation_error(visual(), 20.0), "");
  EXPECT_EQ(validation_error(StartPose{{1, 2, 3}, 0.5, 0.1, 0.1}), "");
  ImuSample no_fog = imu();
  no_fog.fog_delta_yaw_rad = kNaN;
  EXPECT_EQ(validation_error(no_fog), "");
}

TEST(Inputs, InvalidImuIsRejected) {
  const std::vector<std::function<void(ImuSample&)>> mutations = {
      [](ImuSample& s) { s.dt_s = 0.0; },
      [](ImuSample& s) { s.dt_s = kNaN; },
      [](ImuSample& s) { s.dt_s = 5.0; },
      [](ImuSample& s) { s.delta_angle_rad.y() = kNaN; },
      [](ImuSample& s) { s.delta_angle_rad.y() = 1.0; },
      [](ImuSample& s) { s.delta_velocity_mps.x() = kInfinity; },
      [](ImuSample& s) { s.delta_velocity_mps.x() = 10.0; },
      [](ImuSample& s) { s.fog_delta_yaw_rad = 1.0; },
  };
  for (size_t i = 0; i < mutations.size(); ++i) {
    ImuSample s = imu();
    mutations[i](s);
    EXPECT_NE(validation_error(s), "") << i;
  }
}

TEST(Inputs, InvalidVisualMotionIsRejected) {
  const std::vector<std::function<void(VisualMotion&)>> mutations = {
      [](VisualMotion& m) { m.previous_utime = m.utime; },
      [](VisualMotion& m) { m.previous_utime = m.utime + 1; },
      [](VisualMotion& m) { m.keyframe_utime = m.utime; },
      [](VisualMotion& m) { m.T_prev_cur.translation().x() = kNaN; },
      [](VisualMotion& m) { m.T_prev_cur.translation().x() = 100.0; },
      [](VisualMotion& m) { m.cov(2, 2) = kNaN; },
      [](VisualMotion& m) { m.cov(2, 2) = -1.0; },
      [](VisualMotion& m) { m.cov.setZero(); },
      [](VisualMotion& m) { m.cov(0, 1) = 1.0; },
  };
  for (size_t i = 0; i < mutations.size(); ++i) {
    VisualMotion m = visual();
    mutations[i](m);
    EXPECT_NE(validation_error(m, 20.0), "") << i;
  }
  VisualMotion lost;
  lost.utime = 1;
  lost.previous_utime = 0;
  EXPECT_EQ(validation_error(lost, 20.0), "") << "a lost frame has no motion";
}

TEST(Inputs, InvalidStartPoseAndMeasurementAreRejected) {
  EXPECT_NE(validation_error(StartPose{{1, 2, kNaN}, 0.5, 0.1, 0.1}), "");
  EXPECT_NE(validation_error(StartPose{{1, 2, 3}, 0.5, 0.0, 0.1}), "");
  EXPECT_NE(validation_error(StartPose{{1, 2, 3}, 0.5, 0.1, -0.1}), "");
  EXPECT_NE(validation_error(StartPose{{1, 2e9, 3}, 0.5, 0.1, 0.1}), "");
  MapMeasurement m;
  EXPECT_NE(validation_error(m), "") << "no covariance";
  m.cov = Eigen::Matrix3d::Identity();
  EXPECT_EQ(validation_error(m), "");
  m.T_map_odom.yaw_rad = kNaN;
  EXPECT_NE(validation_error(m), "");
}

}  // namespace
}  // namespace rover::loc
