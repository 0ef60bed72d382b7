// DriveWatch: missing channels and clock offsets of a driver, the goal, the stop command.
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
  // Four seconds of driver messages.
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

TEST_F(DriveWatchTest, CompleteDriverHasNoProblem) {
  EXPECT_FALSE(watch_.ticks_received());
  drive([this](Utime t) { all_sensors(t, 0); });
  EXPECT_TRUE(watch_.ticks_received());
  EXPECT_EQ(watch_.driver_problem(), "");
}

TEST_F(DriveWatchTest, MissingChannelsAreReported) {
  drive([this](Utime t) { say<imu_t>(channel::kImu, t); });
  const std::string problem = watch_.driver_problem();
  EXPECT_NE(problem.find("not WHEEL_STATE, LOCCAM_LEFT, LOCCAM_RIGHT"), std::string::npos) << problem;
}

TEST_F(DriveWatchTest, ClockLagIsReported) {
  drive([this](Utime t) { all_sensors(t, 500'000); });
  const std::string problem = watch_.driver_problem();
  EXPECT_NE(problem.find("IMU comes 480 ms behind TICK"), std::string::npos) << problem;
}

TEST_F(DriveWatchTest, ClockLeadIsReported) {
  drive([this](Utime t) { all_sensors(t, -500'000); });
  const std::string problem = watch_.driver_problem();
  EXPECT_NE(problem.find("IMU comes 520 ms ahead of TICK"), std::string::npos) << problem;
}

TEST_F(DriveWatchTest, GoalRequiresStationaryRover) {
  state(supervisor_state_t::GOAL_REACHED, 9);
  EXPECT_FALSE(watch_.stationary_at_goal());
  state(supervisor_state_t::DRIVING, 1);  // to another goal
  state(supervisor_state_t::GOAL_REACHED, 9);
  EXPECT_FALSE(watch_.stationary_at_goal());
  state(supervisor_state_t::GOAL_REACHED, 1);
  EXPECT_TRUE(watch_.stationary_at_goal());
}

TEST_F(DriveWatchTest, StopEndsTheDriveOnlyAtTheGoal) {
  state(supervisor_state_t::DRIVING, 1);
  order(ground_command_t::STOP);
  EXPECT_FALSE(watch_.stop_commanded());
  state(supervisor_state_t::GOAL_REACHED, 1);
  order(ground_command_t::GO);
  EXPECT_FALSE(watch_.stop_commanded());
  order(ground_command_t::STOP);
  EXPECT_TRUE(watch_.stop_commanded());
}

}  // namespace
}  // namespace rover
