// What ./rover drive makes of what it hears: a driver's silent channels and clocks, the goal, the order to stop.
#include "tools/launcher/drive_watch.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <rover/imu_t.hpp>
#include <rover/tick_t.hpp>
#include <rover/wheel_state_t.hpp>

#include "common/bus/channels.hpp"
#include "common/bus/streams.hpp"

namespace rover {
namespace {

class DriveWatchTest : public testing::Test {
 protected:
  template <class Message>
  void say(const char* channel, Utime utime) {
    Message message{};
    message.header = streams_.next(channel, utime, utime);
    bus_.publish(channel, &message);
    hear();
  }
  // Four seconds of a driver.
  void drive(const std::function<void(Utime)>& sensors) {
    for (Utime t = kTickUs; t <= 200 * kTickUs; t += kTickUs) {
      sensors(t);
      say<tick_t>(channel::kTick, t);
    }
  }
  void all_sensors(Utime t, Utime imu_late) {
    say<imu_t>(channel::kImu, t - imu_late);
    say<wheel_state_t>(channel::kWheelState, t);
    say<image_t>(channel::kLocCamLeft, t);
    say<image_t>(channel::kLocCamRight, t);
  }
  void state(std::int8_t value, int times) {
    supervisor_state_t message{};
    message.state = value;
    for (int i = 0; i < times; ++i) {
      bus_.publish(channel::kState, &message);
      hear();
    }
    hear();
  }
  void order(std::int8_t kind) {
    ground_command_t message{};
    message.kind = kind;
    bus_.publish(channel::kGroundCommand, &message);
    hear();
  }
  void hear() {
    while (bus_.handleTimeout(0) > 0) {
    }
  }

  lcm::LCM bus_{"memq://"};
  StreamCounter streams_{"driver", 1};
  DriveWatch watch_{bus_};
};

TEST_F(DriveWatchTest, AWholeDriverIsNoProblem) {
  EXPECT_FALSE(watch_.ticks_heard());
  drive([this](Utime t) { all_sensors(t, 0); });
  EXPECT_TRUE(watch_.ticks_heard());
  EXPECT_EQ(watch_.driver_problem(), "");
}

TEST_F(DriveWatchTest, SilentChannelsAreNamed) {
  drive([this](Utime t) { say<imu_t>(channel::kImu, t); });
  const std::string problem = watch_.driver_problem();
  EXPECT_NE(problem.find("not WHEEL_STATE, LOCCAM_LEFT, LOCCAM_RIGHT"), std::string::npos) << problem;
}

TEST_F(DriveWatchTest, ClocksThatAreApartAreMeasured) {
  drive([this](Utime t) { all_sensors(t, 500'000); });
  const std::string problem = watch_.driver_problem();
  EXPECT_NE(problem.find("IMU comes 480 ms behind TICK"), std::string::npos) << problem;
}

TEST_F(DriveWatchTest, AClockThatIsAheadToo) {
  drive([this](Utime t) { all_sensors(t, -500'000); });
  const std::string problem = watch_.driver_problem();
  EXPECT_NE(problem.find("IMU comes 520 ms ahead of TICK"), std::string::npos) << problem;
}

TEST_F(DriveWatchTest, TheGoalCountsWhenTheRoverRestsThere) {
  state(supervisor_state_t::GOAL_REACHED, 9);
  EXPECT_FALSE(watch_.rests_at_goal());
  state(supervisor_state_t::DRIVING, 1);  // to another goal
  state(supervisor_state_t::GOAL_REACHED, 9);
  EXPECT_FALSE(watch_.rests_at_goal());
  state(supervisor_state_t::GOAL_REACHED, 1);
  EXPECT_TRUE(watch_.rests_at_goal());
}

TEST_F(DriveWatchTest, AnOrderToStopEndsTheDriveAtTheGoalAlone) {
  state(supervisor_state_t::DRIVING, 1);
  order(ground_command_t::STOP);
  EXPECT_FALSE(watch_.stop_ordered());
  state(supervisor_state_t::GOAL_REACHED, 1);
  order(ground_command_t::GO);
  EXPECT_FALSE(watch_.stop_ordered());
  order(ground_command_t::STOP);
  EXPECT_TRUE(watch_.stop_ordered());
}

}  // namespace
}  // namespace rover
