#include "localization/motion_history.hpp"

#include <gtest/gtest.h>

#include "test/localization/synthetic_drive.hpp"

namespace rover::loc {
namespace {

MotionRecord record(Utime start, Utime end) {
  MotionRecord r;
  r.start = start;
  r.end = end;
  r.wheel_motion.x() = to_seconds(end - start);
  return r;
}

TEST(MotionHistory, SliceClipsFirstAndLastRecord) {
  MotionHistory history(60'000'000);
  history.add(record(0, 20'000));
  history.add(record(20'000, 440'000));
  history.add(record(440'000, 460'000));
  const auto parts = history.slice(100'000, 450'000);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].start, 100'000);
  EXPECT_DOUBLE_EQ(parts[0].wheel_motion.x(), 0.34);
  EXPECT_EQ(parts[1].end, 450'000);
  EXPECT_DOUBLE_EQ(parts[1].wheel_motion.x(), 0.01);
}

TEST(MotionHistory, EmptyIntervalGivesEmptySlice) {
  MotionHistory history(60'000'000);
  history.add(record(0, 400'000));
  EXPECT_TRUE(history.slice(200'000, 200'000).empty());
  EXPECT_TRUE(history.slice(400'000, 400'000).empty());
}

// After a stall of the process one record spans all missed ticks, and visual motions start and end within it.
TEST(MotionHistory, PoseStaysFiniteAfterStalls) {
  SyntheticDrive drive(LocalizationConfig{}, 1);
  drive.command = [](double t) { return t < 2.0 ? Twist{} : Twist{0.2, 0.0}; };
  drive.align_and_start();
  for (int i = 0; i < 30; ++i) {
    drive.process_stalled = true;
    drive.run(0.42);
    drive.process_stalled = false;
    drive.run(0.6);
    ASSERT_TRUE(is_finite(drive.localization.pose().T_odom_body)) << i;
  }
  EXPECT_LT((drive.localization.pose().T_odom_body.translation() - drive.truth_odom().translation()).norm(), 0.2);
}

}  // namespace
}  // namespace rover::loc
