#include "tools/status/bus_statistics.hpp"

#include <gtest/gtest.h>

namespace rover::status {
namespace {

// A world whose message time runs at three times real time.
class World {
 public:
  static constexpr double kFactor = 3.0;

  void tick() {
    now_ += kTickUs;
    statistics.add_tick("rover_simulator", now_, wall_s());
    add_message("TICK", "rover_simulator");
  }
  // Calls each(now) after each tick.
  template <class Each>
  void run(double seconds, Each each) {
    const Utime end = now_ + to_utime(seconds);
    while (now_ < end) {
      tick();
      each(now_);
    }
  }
  void run(double seconds) {
    run(seconds, [](Utime) {});
  }
  void add_message(const std::string& channel, const std::string& publisher, Utime delay = 0) {
    statistics.add_message({channel, publisher, boot_[publisher], ++seq_[channel + publisher], now_ - delay, 1000});
  }
  void lose(const std::string& channel, const std::string& publisher, int count) { seq_[channel + publisher] += count; }
  void restart(const std::string& publisher, const std::string& channel) {
    ++boot_[publisher];
    seq_[channel + publisher] = 0;
  }
  // Sets message time; wall time is unchanged.
  void jump(Utime by) {
    now_ += by;
    jumped_ += by;
  }
  Snapshot look() const { return statistics.snapshot({}, wall_s()); }
  Utime now() const { return now_; }
  double wall_s() const { return 1000.0 + to_seconds(now_ - jumped_) / kFactor; }

  BusStatistics statistics;

 private:
  Utime now_ = 60'000'000;
  Utime jumped_ = 0;
  std::map<std::string, std::int64_t> seq_;
  std::map<std::string, std::int64_t> boot_;
};

FaultReport fault(const std::string& id, Utime utime, bool active) {
  return {utime, id, "TRUE", "STOP", 3.0, 2.0, utime, active};
}

StateReport state(Utime utime, std::vector<std::string> faults) {
  StateReport out;
  out.utime = utime;
  out.state = "DRIVING";
  out.since = utime - 2'000'000;
  out.faults = std::move(faults);
  return out;
}

Heartbeat heartbeat(const std::string& service, Utime utime) {
  Heartbeat out;
  out.utime = utime;
  out.service = service;
  out.pid = 42;
  out.health = Health::kOk;
  return out;
}

TEST(BusStatistics, RatesArePerSecondOfMessageTime) {
  World world;
  world.run(3.0, [&](Utime now) {
    world.add_message("POSE", "localization");
    if (now % 400'000 == 0) world.add_message("HAZARDS", "hazard_detector", 240'000);
  });
  const Snapshot s = world.look();
  EXPECT_NEAR(s.realtime_factor, World::kFactor, 1e-6);
  EXPECT_NEAR(s.channels.at("TICK").hz, 50.0, 1e-6);
  EXPECT_NEAR(s.channels.at("POSE").hz, 50.0, 1e-6);
  EXPECT_NEAR(s.channels.at("HAZARDS").hz, 2.5, 1e-6);
  EXPECT_NEAR(s.channels.at("POSE").wall_hz, 50.0 * World::kFactor, 2.0);
  EXPECT_NEAR(s.channels.at("POSE").bytes_per_s, 50e3 * World::kFactor, 2e3);
}

TEST(BusStatistics, RatesOfOneChannelAddUpOverItsPublishers) {
  World world;
  world.run(3.0, [&](Utime now) {
    if (now % 200'000 != 0) return;
    for (const char* service : {"stereo", "localization", "recorder"}) world.add_message("HEARTBEAT", service);
  });
  EXPECT_NEAR(world.look().channels.at("HEARTBEAT").hz, 15.0, 1e-6);
}

TEST(BusStatistics, RateOfStoppedStreamFallsToZero) {
  World world;
  world.run(2.0, [&](Utime) { world.add_message("POSE", "localization"); });
  world.run(4.0);
  const double fading = world.look().channels.at("POSE").hz;
  EXPECT_GT(fading, 0.0);
  EXPECT_LT(fading, 25.0);
  EXPECT_NEAR(world.look().channels.at("POSE").age_s, 4.0, 1e-9);
  world.run(6.0);
  EXPECT_EQ(world.look().channels.at("POSE").hz, 0.0);
  EXPECT_NEAR(world.look().channels.at("POSE").age_s, 10.0, 1e-9);
}

TEST(BusStatistics, TwoMessagesInOneTickDoNotInflateRate) {
  World world;
  world.run(2.0);
  world.add_message("PATH", "path_planner");
  world.add_message("PATH", "path_planner");
  world.run(2.0);
  EXPECT_NEAR(world.look().channels.at("PATH").hz, 0.5, 0.01);
}

TEST(BusStatistics, GapsAreCountedForEachPublisher) {
  World world;
  world.run(0.2);
  for (const char* service : {"stereo", "recorder"}) world.add_message("HEARTBEAT", service);
  world.lose("HEARTBEAT", "stereo", 2);
  world.lose("HEARTBEAT", "recorder", 1);
  for (const char* service : {"stereo", "recorder"}) world.add_message("HEARTBEAT", service);
  EXPECT_EQ(world.look().channels.at("HEARTBEAT").gaps, 3);
  EXPECT_EQ(world.look().channels.at("TICK").gaps, 0);
}

TEST(BusStatistics, PublisherRestartIsNotCountedAsGap) {
  World world;
  world.run(0.2);
  world.add_message("VO", "visual_odometry");
  world.lose("VO", "visual_odometry", 1);
  world.add_message("VO", "visual_odometry");
  world.restart("visual_odometry", "VO");
  for (int i = 0; i < 5; ++i) world.add_message("VO", "visual_odometry");
  EXPECT_EQ(world.look().channels.at("VO").gaps, 1);
}

TEST(BusStatistics, ReorderedAndDuplicateMessagesAreNotCountedAsGaps) {
  World world;
  world.run(0.1);
  for (const std::int64_t seq : {8, 7, 9, 11, 10, 12, 12})
    world.statistics.add_message({"SLIP", "localization", 1, seq, world.now(), 100});
  EXPECT_EQ(world.look().channels.at("SLIP").gaps, 0);
}

TEST(BusStatistics, MeasurementForNextTickHasAgeZero) {
  World world;
  world.run(0.1);
  world.add_message("IMU", "rover_simulator", -kTickUs);
  world.add_message("VO", "visual_odometry", -5 * kTickUs);
  EXPECT_EQ(world.look().channels.at("IMU").age_s, 0.0);
  EXPECT_NEAR(world.look().channels.at("VO").age_s, -0.1, 1e-9);
}

TEST(BusStatistics, AgeIsUnknownWithoutTicks) {
  BusStatistics statistics;
  statistics.add_message({"POSE", "localization", 1, 1, 5'000'000, 100});
  const Snapshot s = statistics.snapshot({}, 10.0);
  EXPECT_EQ(s.now, kNever);
  EXPECT_TRUE(std::isnan(s.channels.at("POSE").hz));
  EXPECT_TRUE(std::isnan(s.channels.at("POSE").age_s));
  EXPECT_TRUE(std::isnan(s.realtime_factor));
}

TEST(BusStatistics, TimeGoingBackResetsStatistics) {
  World world;
  world.run(1.0, [&](Utime) { world.add_message("POSE", "localization"); });
  world.statistics.add_tick("rover_simulator", 0, world.wall_s());
  const Snapshot s = world.look();
  EXPECT_EQ(s.now, 0);
  EXPECT_TRUE(s.channels.empty());
}

TEST(BusStatistics, RatesRecoverAfterJumpOfDays) {
  World world;
  world.run(10.0);
  world.jump(3 * Utime{86'400'000'000});
  EXPECT_EQ(world.look().channels.at("TICK").gaps, 0);
  world.run(5.0);
  EXPECT_NEAR(world.look().channels.at("TICK").hz, 50.0, 0.5);
  EXPECT_NEAR(world.look().realtime_factor, World::kFactor, 0.1);
}

TEST(BusStatistics, SilentChannelAgeComesFromSubscriberHeartbeats) {
  World world;
  world.run(1.0);
  Heartbeat control = heartbeat("trajectory_control", world.now());
  control.newest_input = {{"PATH", world.now() - 30'000'000}, {"TICK", world.now() - 1'000'000}};
  Heartbeat recorder = heartbeat("supervisor", world.now());
  recorder.newest_input = {{"PATH", world.now() - 31'000'000}};
  world.statistics.add_heartbeat(control);
  world.statistics.add_heartbeat(recorder);
  const Snapshot s = world.look();
  EXPECT_NEAR(s.channels.at("PATH").age_s, 30.0, 1e-9);
  EXPECT_EQ(s.channels.at("PATH").hz, 0.0);
  EXPECT_NEAR(s.channels.at("TICK").age_s, 0.0, 1e-9);
}

TEST(BusStatistics, ServiceAgeIsTimeSinceLastHeartbeat) {
  World world;
  world.run(1.0);
  world.statistics.add_heartbeat(heartbeat("stereo", world.now()));
  world.run(2.0);
  world.statistics.add_heartbeat(heartbeat("locomotion", world.now()));
  const ProcessFigures up{7, true, 0, 1.0, 2.0};
  const Snapshot s = world.statistics.snapshot(
      {{"stereo", {}}, {"locomotion", up}, {"recorder", up}, {"rover_simulator", up}}, world.wall_s() + 0.5);
  EXPECT_FALSE(s.services.at("stereo").process.alive);
  EXPECT_NEAR(s.services.at("stereo").age_s, 2.0, 1e-9);
  EXPECT_EQ(s.services.at("locomotion").age_s, 0.0);
  EXPECT_TRUE(std::isnan(s.services.at("recorder").age_s));
  EXPECT_NEAR(s.services.at("recorder").quiet_s, 2.98, 1e-9);
  EXPECT_NEAR(s.services.at("rover_simulator").age_s, 0.5, 1e-6) << "of wall time, since the last tick";
}

TEST(BusStatistics, ActiveFaultsHaveValueAndLimit) {
  World world;
  world.run(1.0);
  const Utime now = world.now();
  world.statistics.add_fault(fault("slip", now - 500'000, true));
  world.statistics.add_state(state(now - 100'000, {"pose_age", "slip"}));
  const Snapshot s = world.look();
  ASSERT_EQ(s.faults.size(), 2u);
  EXPECT_EQ(s.faults[0].report.id, "pose_age");
  EXPECT_TRUE(std::isnan(s.faults[0].report.value)) << "never heard";
  EXPECT_EQ(s.faults[1].report.id, "slip");
  EXPECT_EQ(s.faults[1].report.value, 3.0);
  EXPECT_NEAR(s.faults[1].for_s, 0.5, 1e-9);
  EXPECT_NEAR(s.state_for_s, 2.1, 1e-9);
}

TEST(BusStatistics, FaultsAreRaisedAndClearedBetweenStates) {
  World world;
  world.run(1.0);
  const Utime now = world.now();
  world.statistics.add_state(state(now - 100'000, {"slip"}));
  world.statistics.add_fault(fault("tilt", now - 40'000, true));
  ASSERT_EQ(world.look().faults.size(), 2u);
  world.statistics.add_fault(fault("slip", now - 20'000, false));
  ASSERT_EQ(world.look().faults.size(), 1u);
  EXPECT_EQ(world.look().faults[0].report.id, "tilt");
  world.statistics.add_state(state(now, {}));
  EXPECT_TRUE(world.look().faults.empty()) << "STATE has the last word";
}

}  // namespace
}  // namespace rover::status
