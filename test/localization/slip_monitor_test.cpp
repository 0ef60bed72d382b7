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
  r.wheels = true;
  r.turned_rad.fill(speed_mps * 0.02 / 0.125);
  r.commanded_path_m = speed_mps * 0.02;
  return r;
}

// Drives at a wheel speed and a visual speed from `from` on.
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

TEST(SlipMonitor, RatioOfTheWindow) {
  SlipMonitor monitor({}, WheelOdometry(test_vehicle()));
  drive(monitor, 0, 10.0, 0.2, 0.05);
  const Slip slip = monitor.slip(10'000'000);
  EXPECT_TRUE(slip.valid);
  EXPECT_NEAR(slip.slip_ratio, 0.75, 1e-9);
  EXPECT_NEAR(slip.window_s, 5.0, 1e-9);
  EXPECT_NEAR(monitor.grip(), 0.25, 1e-9);
}

TEST(SlipMonitor, SlidingDownhillOnTurningWheelsIsNegative) {
  SlipMonitor monitor({}, WheelOdometry(test_vehicle()));
  drive(monitor, 0, 10.0, 0.1, 0.15);
  EXPECT_NEAR(monitor.slip(10'000'000).slip_ratio, -0.5, 1e-9);
}

TEST(SlipMonitor, StuckWheelsShowAsFullSlip) {
  SlipMonitor monitor({}, WheelOdometry(test_vehicle()));
  drive(monitor, 0, 10.0, 0.2, 0.0);
  EXPECT_NEAR(monitor.slip(10'000'000).slip_ratio, 1.0, 1e-9);
}

// The original's buffer froze at standstill, and its slip stop never cleared.
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

TEST(SlipMonitor, NothingKnownIsNotZeroSlip) {
  const SlipMonitor monitor({}, WheelOdometry(test_vehicle()));
  EXPECT_FALSE(monitor.slip(0).valid);
  EXPECT_TRUE(std::isnan(monitor.slip(0).slip_ratio));
  EXPECT_TRUE(std::isnan(monitor.slip(0).visual_mps));
}

}  // namespace
}  // namespace rover::loc
