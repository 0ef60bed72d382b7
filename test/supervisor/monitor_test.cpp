#include "supervisor/monitor.hpp"

#include <gtest/gtest.h>

namespace rover::supervisor {
namespace {

MonitorRow row(double persistence_s, bool latched = false) {
  MonitorRow out;
  out.id = "row";
  out.quantity = "quantity";
  out.limit = 1.0;
  out.persistence_s = persistence_s;
  out.clear_s = 1.0;
  out.latched = latched;
  return out;
}

// Seconds until the monitor changes for a constant value, -1 if it does not within 10 s.
double time_to_change(Monitor& monitor, Utime& now, double value, bool armed = true) {
  const Utime start = now;
  for (; now - start <= to_utime(10.0); now += kTickUs)
    if (monitor.step(now, armed, above_reading(value, 1.0, now, now))) return to_seconds(now - start);
  return -1.0;
}

TEST(Monitor, RaisesAfterPersistenceAndClearsAfterClearTime) {
  Monitor monitor(row(0.5));
  Utime now = 0;
  EXPECT_EQ(time_to_change(monitor, now, 0.5), -1.0);
  EXPECT_NEAR(time_to_change(monitor, now, 1.5), 0.5, 1e-9);
  EXPECT_TRUE(monitor.blocks_motion());
  EXPECT_EQ(monitor.visible_utime(), now);
  EXPECT_NEAR(time_to_change(monitor, now, 0.5), 1.0, 1e-9);
  EXPECT_FALSE(monitor.active());
}

TEST(Monitor, ShortExcursionsDoNotRaise) {
  Monitor monitor(row(0.1));
  for (int i = 0; i < 100; ++i)
    EXPECT_FALSE(monitor.step(i * kTickUs, true, above_reading(i % 4 == 0 ? 0.0 : 2.0, 1.0, i * kTickUs, i * kTickUs)));
}

TEST(Monitor, BadReadingRestartsTheClearTime) {
  Monitor monitor(row(0.0));
  Utime now = 0;
  time_to_change(monitor, now, 2.0);
  for (int i = 0; i < 200; ++i, now += kTickUs)
    EXPECT_FALSE(monitor.step(now, true, above_reading(i % 25 == 0 ? 2.0 : 0.0, 1.0, now, now)));
  EXPECT_TRUE(monitor.active());
}

TEST(Monitor, NanAndSilenceRaise) {
  Monitor nan(row(0.0));
  EXPECT_TRUE(nan.step(0, true, above_reading(kNaN, 1.0, 0, 0)));
  EXPECT_EQ(nan.reading().condition, Condition::kInvalid);
  Monitor silent(row(0.0));
  EXPECT_TRUE(silent.step(0, true, age_reading(kNever, 0, 1.0)));
  EXPECT_EQ(silent.reading().condition, Condition::kStale);
  Monitor old(row(0.0));
  EXPECT_FALSE(old.step(1'000'000, true, age_reading(0, 1'000'000, 1.0)));
  EXPECT_TRUE(old.step(1'000'001, true, age_reading(0, 1'000'001, 1.0)));
}

TEST(Monitor, DataOfTheFutureAreInvalidNotFresh) {
  MonitorRow counted = row(0.0);
  counted.n = counted.m = 3;
  Monitor monitor(counted);
  const auto step = [&](Utime now) { return monitor.step(now, true, age_reading(3'600'000'000, now, 1.0)); };
  EXPECT_FALSE(step(0));
  EXPECT_FALSE(step(kTickUs));
  EXPECT_TRUE(step(2 * kTickUs));
  EXPECT_EQ(monitor.reading().condition, Condition::kInvalid);
  EXPECT_EQ(monitor.visible_utime(), 2 * kTickUs);
  EXPECT_EQ(age_reading(1'000, 1'000, 1.0).condition, Condition::kFalse);
}

TEST(Monitor, NOfMCountsMeasurementsNotTicks) {
  MonitorRow counted = row(0.0);
  counted.n = 3;
  counted.m = 5;
  Monitor monitor(counted);
  // The same bad measurement, evaluated many times, counts once.
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(monitor.step(i * kTickUs, true, above_reading(2.0, 1.0, 0, i * kTickUs)));
  Utime now = 20 * kTickUs;
  const auto measure = [&](double value) {
    now += kTickUs;
    return monitor.step(now, true, above_reading(value, 1.0, now, now));
  };
  EXPECT_FALSE(measure(0.0));
  EXPECT_FALSE(measure(2.0));
  EXPECT_FALSE(measure(0.0));
  EXPECT_TRUE(measure(2.0));  // including the first one: three of the newest five
  EXPECT_EQ(monitor.visible_utime(), now);
}

TEST(Monitor, TwoBadOfFiveDoNotRaiseThreeOfFive) {
  MonitorRow counted = row(0.0);
  counted.n = 3;
  counted.m = 5;
  Monitor monitor(counted);
  for (int i = 0; i < 100; ++i)
    EXPECT_FALSE(monitor.step(i * kTickUs, true, above_reading(i % 5 < 2 ? 2.0 : 0.0, 1.0, i * kTickUs, i * kTickUs)));
}

TEST(Monitor, RestoredFaultClearsLikeAnyOther) {
  Monitor monitor(row(0.0));
  monitor.restore_active();
  Utime now = 0;
  EXPECT_NEAR(time_to_change(monitor, now, 0.0), 1.0, 1e-9);
  EXPECT_FALSE(monitor.active());
}

TEST(Monitor, LatchedFaultNeedsAGroundCommand) {
  Monitor monitor(row(0.0, true));
  Utime now = 0;
  time_to_change(monitor, now, 2.0);
  EXPECT_FALSE(monitor.unlatch(above_reading(2.0, 1.0, now, now)));
  EXPECT_EQ(time_to_change(monitor, now, 0.0), -1.0);
  EXPECT_TRUE(monitor.active());
  EXPECT_TRUE(monitor.unlatch(above_reading(0.0, 1.0, now, now)));
  EXPECT_FALSE(monitor.active());
}

TEST(Monitor, AfterUnlatchingTheFullPersistenceApplies) {
  Monitor monitor(row(0.5, true));
  Utime now = 0;
  EXPECT_NEAR(time_to_change(monitor, now, 2.0), 0.5, 1e-9);
  now += kTickUs;
  EXPECT_TRUE(monitor.unlatch(above_reading(0.0, 1.0, now, now)));
  EXPECT_NEAR(time_to_change(monitor, now, 2.0), 0.5, 1e-9);
}

TEST(Monitor, DisarmedMonitorClearsAndForgets) {
  Monitor monitor(row(0.0, true));
  Utime now = 0;
  EXPECT_EQ(time_to_change(monitor, now, 2.0, false), -1.0);
  EXPECT_EQ(time_to_change(monitor, now, 2.0), 0.0);
  EXPECT_EQ(time_to_change(monitor, now, 2.0, false), 0.0);
  EXPECT_FALSE(monitor.active());
}

TEST(Monitor, LogResponseDoesNotBlockMotion) {
  MonitorRow logged = row(0.0);
  logged.response = Response::kLog;
  Monitor monitor(logged);
  EXPECT_TRUE(monitor.step(0, true, above_reading(2.0, 1.0, 0, 0)));
  EXPECT_TRUE(monitor.active());
  EXPECT_FALSE(monitor.blocks_motion());
}

}  // namespace
}  // namespace rover::supervisor
