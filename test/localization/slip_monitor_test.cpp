#include "localization/slip_monitor.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "synthetic_drive.hpp"

namespace rover::loc {
namespace {

MotionRecord tick(Utime end, double speed_mps) {
  MotionRecord r;
  r.start = end - kTickUs;
  r.end = end;
  r.wheels_valid = true;
  r.wheel_turn_rad.fill(speed_mps * 0.02 / 0.125);
  r.commanded_path_m = speed_mps * 0.02;
  return r;
}

// Drives with constant wheel and visual speed, starting at `from`.
void drive(SlipMonitor& monitor, Utime from, double seconds, double wheel_mps, double visual_mps) {
  std::vector<MotionRecord> interval;
  for (Utime t = from + kTickUs; t <= from + to_utime(seconds); t += kTickUs) {
    interval.push_back(tick(t, wheel_mps));
    monitor.add(interval.back());
    if (interval.size() < 20) continue;
    monitor.add_visual(interval, {visual_mps * 0.4, 0.0, 0.0});
    interval.clear();
  }
}

TEST(SlipMonitor, SlipRatioOfWindow) {
  SlipMonitor monitor({}, WheelOdometry(test_vehicle()));
  drive(monitor, 0, 10.0, 0.2, 0.05);
  const Slip slip = monitor.slip(10'000'000);
  EXPECT_TRUE(slip.valid);
  EXPECT_NEAR(slip.slip_ratio, 0.75, 1e-9);
  EXPECT_NEAR(slip.window_s, 5.0, 1e-9);
  EXPECT_NEAR(monitor.traction(0), 0.25, 1e-9);
}

// The last images before a lens failed may have been wrong.
TEST(SlipMonitor, WithoutImagesForLongTheMeanTractionCounts) {
  SlipMonitor monitor({}, WheelOdometry(test_vehicle()));
  drive(monitor, 0, 60.0, 0.2, 0.19);
  drive(monitor, 60'000'000, 2.0, 0.2, 0.1);
  EXPECT_NEAR(monitor.traction(62'000'000), 0.5, 1e-9);
  EXPECT_NEAR(monitor.traction(70'000'000), 0.94, 0.03);
}

TEST(SlipMonitor, SlidingDownhillGivesNegativeSlip) {
  SlipMonitor monitor({}, WheelOdometry(test_vehicle()));
  drive(monitor, 0, 10.0, 0.1, 0.15);
  EXPECT_NEAR(monitor.slip(10'000'000).slip_ratio, -0.5, 1e-9);
}

TEST(SlipMonitor, StuckRoverGivesFullSlip) {
  SlipMonitor monitor({}, WheelOdometry(test_vehicle()));
  drive(monitor, 0, 10.0, 0.2, 0.0);
  EXPECT_NEAR(monitor.slip(10'000'000).slip_ratio, 1.0, 1e-9);
}

// Otherwise a slip stop would never clear.
TEST(SlipMonitor, WindowEmptiesAtStandstill) {
  SlipMonitor monitor({}, WheelOdometry(test_vehicle()));
  drive(monitor, 0, 10.0, 0.2, 0.0);
  ASSERT_TRUE(monitor.slip(10'000'000).valid);
  drive(monitor, 10'000'000, 5.4, 0.0, 0.0);
  const Slip slip = monitor.slip(15'400'000);
  EXPECT_FALSE(slip.valid);
  EXPECT_TRUE(std::isnan(slip.slip_ratio));
  EXPECT_EQ(slip.wheel_mps, 0.0);
  EXPECT_EQ(slip.commanded_mps, 0.0);
}

// On an arc with a lateral drift to the left for each metre rolled.
double side_slip_on_arc(double speed_mps, double yaw_rate_radps, double lateral_per_m,
                        double wheel_lateral_per_m = 0.0) {
  SlipMonitor monitor({}, WheelOdometry(test_vehicle()));
  constexpr double kIntervalS = 0.4;
  Utime t = 0;
  for (int i = 0; i < 10; ++i) {
    std::vector<MotionRecord> interval;
    for (int k = 0; k < 20; ++k) {
      interval.push_back(tick(t += kTickUs, speed_mps));
      interval.back().wheel_motion = {speed_mps * 0.02, wheel_lateral_per_m * std::abs(speed_mps) * 0.02,
                                      yaw_rate_radps * 0.02};
      monitor.add(interval.back());
    }
    const double half = 0.5 * yaw_rate_radps * kIntervalS;
    const double chord = speed_mps * kIntervalS * std::sin(half) / half;
    const double lateral = lateral_per_m * std::abs(speed_mps) * kIntervalS;
    monitor.add_visual(interval, {chord * std::cos(half) - lateral * std::sin(half),
                                  chord * std::sin(half) + lateral * std::cos(half), 2.0 * half});
  }
  return monitor.newest_side_slip();
}

TEST(SlipMonitor, SideSlipExcludesWheelOdometryAndCurvature) {
  EXPECT_NEAR(side_slip_on_arc(0.2, 0.15, 0.0), 0.0, 1e-9);
  EXPECT_NEAR(side_slip_on_arc(0.2, -0.15, 0.09), 0.09, 1e-9);
  EXPECT_NEAR(side_slip_on_arc(-0.2, 0.15, 0.09), 0.09, 1e-9) << "same sign forward and backward";
  EXPECT_NEAR(side_slip_on_arc(0.2, 0.15, 0.09, 0.03), 0.06, 1e-4) << "lateral wheel odometry is not slip";
  EXPECT_NEAR(side_slip_on_arc(0.02, 0.15, 0.09), 0.09 * 0.04 / 0.15, 1e-4) << "small over a short distance";
}

TEST(SlipMonitor, RecordsWithoutWheelsInTheMiddleDoNotStraightenTheWheels) {
  SlipMonitor monitor({}, WheelOdometry(test_vehicle()));
  const Vehicle v = test_vehicle();
  constexpr double kTurnRad = 0.08;
  std::array<double, 6> travel_m{};  // of each wheel in a point turn
  for (size_t i = 0; i < 6; ++i)
    travel_m[i] = std::copysign(std::hypot(v.wheel_x_m[i], v.wheel_y_m[i]) * kTurnRad, -v.wheel_y_m[i]);
  std::vector<MotionRecord> interval;
  for (int k = 0; k < 20; ++k) {
    MotionRecord r = tick((k + 1) * kTickUs, 0.0);
    for (size_t i = 0; i < 4; ++i) {
      const auto wheel = static_cast<size_t>(kSteeredWheels[i]);
      r.steer_rad[i] = std::atan2(v.wheel_x_m[wheel], -v.wheel_y_m[wheel]);
      if (std::abs(r.steer_rad[i]) > 0.5 * kPi) r.steer_rad[i] = wrap_angle(r.steer_rad[i] + kPi);
    }
    for (size_t i = 0; i < 6; ++i) r.wheel_turn_rad[i] = travel_m[i] / v.wheel_radius_m / 20.0;
    if (k >= 8 && k < 12) {
      r.wheels_valid = false;
      r.steer_rad = {};
    }
    monitor.add(r);
    interval.push_back(r);
  }
  monitor.add_visual(interval, {0.0, 0.0, kTurnRad});
  EXPECT_NEAR(monitor.newest_traction(), 20.0 / 16.0, 1e-6);
}

TEST(SlipMonitor, UnknownSlipIsNotZero) {
  const SlipMonitor monitor({}, WheelOdometry(test_vehicle()));
  EXPECT_FALSE(monitor.slip(0).valid);
  EXPECT_TRUE(std::isnan(monitor.slip(0).slip_ratio));
  EXPECT_TRUE(std::isnan(monitor.slip(0).visual_mps));
}

}  // namespace
}  // namespace rover::loc
