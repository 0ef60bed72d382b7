// Faults of sensors, vehicle, clock and processes, observed on an in-memory bus.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <numeric>
#include <rover/image_t.hpp>
#include <rover/imu_t.hpp>
#include <rover/injection_t.hpp>
#include <rover/tick_t.hpp>
#include <rover/truth_t.hpp>
#include <rover/wheel_state_t.hpp>

#include "common/bus/channels.hpp"
#include "common/bus/vehicle_config.hpp"
#include "rover_simulator/simulator.hpp"

namespace rover {
namespace {

const std::string kConfigDir = std::string(ROVER_SOURCE_DIR) + "/config";
constexpr Utime kStart = 1'000'000;

// Records all messages of a channel.
template <class Message>
void record(lcm::LCM& bus, const char* channel, std::vector<Message>& messages) {
  bus.subscribeFunction(
      channel,
      +[](const lcm::ReceiveBuffer* buffer, const std::string&, std::vector<Message>* out) {
        Message message;
        if (decode_message(buffer->data, static_cast<int>(buffer->data_size), message)) out->push_back(message);
      },
      &messages);
}

struct Circumstances {
  bool realtime = false;
  Utime dies_at = kNever;  // the driver, without any order
  int lost = 0;            // messages that the driver did not receive
};

// Service that drives straight ahead. Its process is a sleeping child, restarted after it was killed.
class Driver {
 public:
  Driver(lcm::LCM& bus, const Circumstances& circumstances) : bus_(bus), circumstances_(circumstances) {
    bus_.subscribeFunction(
        channel::kTick,
        +[](const lcm::ReceiveBuffer* buffer, const std::string&, Driver* driver) {
          tick_t tick;
          if (decode_message(buffer->data, static_cast<int>(buffer->data_size), tick)) driver->on_tick(tick);
        },
        this);
    start();
  }
  ~Driver() { end(); }
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

  const std::vector<Utime>& ticks() const { return ticks_; }
  int boots() const { return boot_; }

 private:
  void start() {
    ++boot_;
    streams_ = std::make_unique<StreamCounter>("driver", boot_);
    child_ = fork();
    if (child_ == 0)
      while (true) pause();
    publish_done(kNever);
  }
  void end() {
    if (child_ <= 0) return;
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
    child_ = -1;
  }
  // A tick without this member means that its process has died.
  void on_tick(const tick_t& tick) {
    if (tick.members.empty()) {
      if (child_ < 0 || waitpid(child_, nullptr, WNOHANG) == child_) start();
      return;
    }
    if (tick.header.utime == circumstances_.dies_at) return end();
    ticks_.push_back(tick.header.utime);
    wheel_command_t command{};
    command.valid_until_utime = tick.header.utime + 10 * kTickUs;
    for (double& rate : command.drive_rate_radps) rate = 1.0;
    command.header = streams_->next(channel::kWheelCommand, tick.header.utime, tick.header.utime + kTickUs);
    bus_.publish(channel::kWheelCommand, &command);
    publish_done(tick.header.utime);
  }
  void publish_done(Utime t) {
    done_t done{};
    done.tick_utime = t;
    done.promise_utime = kNever;
    done.pid = child_;
    done.lost = t == kNever ? 0 : circumstances_.lost;
    done.header = streams_->next(channel::kDone, t, t);
    bus_.publish(channel::kDone, &done);
  }

  lcm::LCM& bus_;
  Circumstances circumstances_;
  std::unique_ptr<StreamCounter> streams_;
  std::vector<Utime> ticks_;
  int boot_ = 0;
  int child_ = -1;
};

struct Recording {
  SimulationSummary summary;
  std::vector<imu_t> imu;
  std::vector<wheel_state_t> wheels;
  std::vector<image_t> left, right;
  std::vector<injection_t> injections;
  std::vector<truth_t> truth;
  std::vector<Utime> ticks;
  int boots = 0;
};

ScriptedFault at_second(double at_s, const std::string& fault, const std::string& target, double amount = 0.0) {
  ScriptedFault scripted;
  scripted.order = {fault, target, amount};
  scripted.at_s = at_s;
  return scripted;
}

// Drives for some seconds on a smooth firm plane.
Recording drive(std::vector<ScriptedFault> faults, double seconds = 2.0, const Circumstances& circumstances = {}) {
  SimulatedRoverConfig config;
  config.loccam.scene.fine_radius_m = 4.5;
  config.loccam.scene.middle_radius_m = 8.0;
  config.loccam.scene.far_radius_m = 30.0;
  WorldConfig plane;
  plane.soil.everywhere = Soil::kFirm;
  plane.rocks.k = 0.0;
  plane.roughness.rms_m = 0.0;
  auto world = std::make_unique<World>(plane, plane_raster(40.0, 40.0, 1.0, 0.0, 0.0), 1);
  SimulatedRover rover(config, load_vehicle(kConfigDir), load_stereo_rig(kConfigDir, "loccam"), std::move(world),
                       {20.0, 20.0, 0.0}, 1);
  SimulatorOptions options;
  options.participants = {"driver"};
  options.end.timeout_s = seconds;
  options.faults = std::move(faults);
  options.realtime = circumstances.realtime;
  Recording recorded;
  lcm::LCM bus("memq://");
  record(bus, channel::kImu, recorded.imu);
  record(bus, channel::kWheelState, recorded.wheels);
  record(bus, channel::kLocCamLeft, recorded.left);
  record(bus, channel::kLocCamRight, recorded.right);
  record(bus, channel::kInject, recorded.injections);
  record(bus, channel::kTruth, recorded.truth);
  testing::internal::CaptureStdout();
  {
    Simulator simulator(options, rover, bus);
    const Driver driver(bus, circumstances);
    recorded.summary = simulator.run([] { return true; });
    recorded.ticks = driver.ticks();
    recorded.boots = driver.boots();
  }
  testing::internal::GetCapturedStdout();
  return recorded;
}

double mean(const std::vector<std::uint8_t>& data) {
  return std::accumulate(data.begin(), data.end(), 0.0) / static_cast<double>(data.size());
}

TEST(SimulatorFaults, BlindCameraGivesBlackImages) {
  const Recording recorded = drive({at_second(1.0, "camera_blind", "left")});
  ASSERT_GE(recorded.left.size(), 4u);
  EXPECT_GT(mean(recorded.left.front().data), 20.0);
  EXPECT_EQ(mean(recorded.left.back().data), 0.0);
  EXPECT_GT(mean(recorded.right.back().data), 20.0);
}

TEST(SimulatorFaults, FrozenCameraRepeatsLastImage) {
  const Recording recorded = drive({at_second(0.6, "camera_frozen", "both")});
  ASSERT_GE(recorded.left.size(), 4u);
  EXPECT_NE(recorded.left[0].data, recorded.left[1].data);
  EXPECT_EQ(recorded.left[2].data, recorded.left[1].data);
  EXPECT_EQ(recorded.left.back().data, recorded.left[1].data);
  EXPECT_EQ(recorded.right.back().data, recorded.right[1].data);
}

TEST(SimulatorFaults, ShiftedCameraShiftsImageByPixels) {
  const Recording good = drive({}, 1.0);
  const Recording recorded = drive({at_second(0.0, "camera_rows", "right", 3)}, 1.0);
  const image_t& image = recorded.right.at(1);
  const auto w = static_cast<size_t>(image.width);
  EXPECT_TRUE(std::equal(image.data.begin() + static_cast<std::ptrdiff_t>(3 * w), image.data.end(),
                         good.right.at(1).data.begin()));
  EXPECT_EQ(recorded.left.at(1).data, good.left.at(1).data);
}

TEST(SimulatorFaults, DirtyFoggedDazzledAndRolledCamerasSeeLess) {
  const Recording good = drive({}, 1.0);
  const auto seen = [](const std::string& fault, double amount) {
    return drive({at_second(0.0, fault, "left", amount)}, 1.0).left.at(1).data;
  };
  const auto& clear = good.left.at(1).data;
  const auto span = [](const auto& data) {
    return *std::max_element(data.begin(), data.end()) - *std::min_element(data.begin(), data.end());
  };
  EXPECT_LT(span(seen("camera_fog", 0.8)), 0.3 * span(clear));
  const auto dirty = seen("camera_dirt", 0.3);
  size_t changed = 0;
  for (size_t i = 0; i < clear.size(); ++i)
    changed += std::abs(dirty[i] - clear[i]) > 0.5 * std::abs(clear[i] - 40) ? 1 : 0;
  EXPECT_NEAR(static_cast<double>(changed) / static_cast<double>(clear.size()), 0.3, 0.05);
  const auto dazzled = seen("camera_glare", 0.2);
  EXPECT_GT(std::count(dazzled.begin(), dazzled.end(), 255), static_cast<std::ptrdiff_t>(clear.size() / 20));
  EXPECT_EQ(dazzled.back(), clear.back());
  EXPECT_NE(seen("camera_roll", 0.5), clear);
}

TEST(SimulatorFaults, DeadImuPublishesNothing) {
  const Recording recorded = drive({at_second(1.0, "imu_dead", "imu")});
  EXPECT_EQ(recorded.imu.size(), 50u);
  EXPECT_GE(recorded.wheels.size(), 100u);
}

TEST(SimulatorFaults, BiasFaultsAppearInIncrements) {
  const Recording good = drive({}, 1.0);
  const Recording recorded =
      drive({at_second(0.0, "gyro_bias", "imu", 0.1), at_second(0.0, "accel_bias", "imu", 2.0)}, 1.0);
  const imu_t& biased = recorded.imu.at(20);
  EXPECT_NEAR(biased.delta_angle_rad[2] - good.imu.at(20).delta_angle_rad[2], 0.1 * biased.dt_s, 1e-12);
  EXPECT_NEAR(biased.fog_delta_yaw_rad - good.imu.at(20).fog_delta_yaw_rad, 0.1 * biased.dt_s, 1e-12);
  EXPECT_NEAR(biased.delta_velocity_mps[0] - good.imu.at(20).delta_velocity_mps[0], 2.0 * biased.dt_s, 1e-12);
}

TEST(SimulatorFaults, StuckEncoderReadsConstantWhileWheelTurns) {
  const Recording recorded = drive({at_second(1.0, "encoder_stuck", "2")});
  const wheel_state_t& last = recorded.wheels.back();
  EXPECT_EQ(last.drive_angle_rad[2], recorded.wheels.at(49).drive_angle_rad[2]);
  EXPECT_EQ(last.drive_rate_radps[2], 0.0);
  EXPECT_GT(last.drive_angle_rad[3] - recorded.wheels.at(49).drive_angle_rad[3], 0.8);
}

TEST(SimulatorFaults, JammedWheelStopsAndCurrentReachesLimit) {
  const Recording recorded = drive({at_second(1.0, "wheel_jammed", "4")});
  const wheel_state_t& last = recorded.wheels.back();
  EXPECT_NEAR(last.drive_rate_radps[4], 0.0, 0.02);
  EXPECT_GT(last.drive_current_a[4], 8.0);
  EXPECT_LT(recorded.wheels.at(45).drive_current_a[4], 2.0);
  EXPECT_NEAR(last.drive_rate_radps[5], 1.0, 0.1);
}

TEST(SimulatorFaults, LooseSandIncreasesSlip) {
  const auto slip = [](const truth_t& truth) {
    return std::accumulate(truth.wheel_slip, truth.wheel_slip + 6, 0.0) / 6;
  };
  const Recording good = drive({}, 4.0);
  const Recording recorded = drive({at_second(1.0, "loose_sand", "ground")}, 4.0);
  EXPECT_EQ(recorded.truth.back().wheel_soil[0], std::int8_t{truth_t::SAND});
  EXPECT_GT(slip(recorded.truth.back()), slip(good.truth.back()) + 0.02);
}

TEST(SimulatorFaults, TiltActsOnImuLikeSlope) {
  const Recording recorded = drive({at_second(1.0, "tilt_pitch", "ground", 20.0)}, 4.0);
  // On a slope that falls ahead by 20 degrees specific force points up, that is backwards in the body.
  double forward = 0.0, up = 0.0, turned = 0.0;
  for (const imu_t& imu : recorded.imu) turned += imu.delta_angle_rad[1];
  EXPECT_NEAR(turned, to_rad(20.0), to_rad(2.0));
  for (size_t i = recorded.imu.size() - 50; i < recorded.imu.size(); ++i) {
    forward += recorded.imu[i].delta_velocity_mps[0];
    up += recorded.imu[i].delta_velocity_mps[2];
  }
  EXPECT_NEAR(std::atan2(-forward, up), to_rad(20.0), to_rad(4.0));
}

TEST(SimulatorFaults, TiltRampsUpAndDown) {
  ScriptedFault tilt = at_second(1.0, "tilt_roll", "ground", 20.0);
  tilt.order.for_s = 2.0;
  const Recording recorded = drive({tilt}, 5.5);
  double turned = 0.0, most = 0.0;
  for (const imu_t& imu : recorded.imu) {
    turned += imu.delta_angle_rad[0];
    most = std::max(most, turned);
  }
  EXPECT_NEAR(most, to_rad(20.0), to_rad(2.0));
  EXPECT_NEAR(turned, 0.0, to_rad(2.0));
}

TEST(SimulatorFaults, ClockStepsOnceAndRunContinues) {
  const Recording recorded = drive({at_second(1.0, "clock_step", "clock", 5.0)}, 7.0);
  EXPECT_EQ(recorded.summary.outcome, "timeout");
  EXPECT_TRUE(recorded.summary.deterministic);
  int jumps = 0;
  for (size_t i = 1; i < recorded.ticks.size(); ++i) {
    const Utime step = recorded.ticks[i] - recorded.ticks[i - 1];
    if (step == kTickUs) continue;
    EXPECT_EQ(step, kTickUs + 5'000'000);
    EXPECT_EQ(recorded.ticks[i - 1], kStart + 1'000'000);
    ++jumps;
  }
  EXPECT_EQ(jumps, 1);
}

// If it waited for the step to pass, the test would run into its time limit.
TEST(SimulatorFaults, ClockStepInRealTimeIsNotWaitedFor) {
  const Recording recorded = drive({at_second(0.4, "clock_step", "clock", 3600.0)}, 3601.0, {.realtime = true});
  EXPECT_EQ(recorded.summary.outcome, "timeout");
}

TEST(SimulatorFaults, EveryFaultIsPublishedOnInject) {
  const Recording recorded = drive({at_second(0.5, "drop", "POSE", 0.3), at_second(0.7, "gyro_bias", "imu", 0.1)}, 1.0);
  ASSERT_EQ(recorded.injections.size(), 2u);
  EXPECT_EQ(recorded.injections[0].target, "POSE");
  EXPECT_EQ(recorded.injections[0].from_utime, kStart + 500'000);
  EXPECT_EQ(recorded.injections[1].injection_id, 2);
}

TEST(SimulatorFaults, KilledServiceRejoinsAfterOneSecondAndReceivesActiveFaults) {
  const Recording recorded = drive({at_second(0.5, "drop", "POSE", 0.3), at_second(1.0, "kill", "driver")}, 3.0);
  EXPECT_EQ(recorded.boots, 2);
  EXPECT_TRUE(recorded.summary.deterministic);
  const auto gap = std::find(recorded.ticks.begin(), recorded.ticks.end(), kStart + 980'000);
  ASSERT_NE(gap, recorded.ticks.end());
  EXPECT_EQ(*(gap + 1), kStart + 2'000'000);
  ASSERT_EQ(recorded.injections.size(), 3u);
  EXPECT_EQ(recorded.injections[2].injection_id, 1);
  EXPECT_EQ(recorded.injections[2].header.utime, kStart + 2'020'000);
}

TEST(SimulatorFaults, DeathThatTheScenarioDidNotOrderIsNotDeterministic) {
  const Recording recorded = drive({}, 3.0, {.dies_at = kStart + 1'000'000});
  EXPECT_EQ(recorded.boots, 2);
  ASSERT_EQ(recorded.summary.left.size(), 1u);
  EXPECT_EQ(recorded.summary.left[0].rfind("driver died at ", 0), 0u) << recorded.summary.left[0];
  EXPECT_FALSE(recorded.summary.deterministic);
}

TEST(SimulatorFaults, RunInWhichAServiceLostAMessageIsNotDeterministic) {
  EXPECT_TRUE(drive({}, 0.5).summary.deterministic);
  EXPECT_FALSE(drive({}, 0.5, {.lost = 1}).summary.deterministic);
}

}  // namespace
}  // namespace rover
