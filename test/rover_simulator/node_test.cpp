// Simulator with one participant on an in-memory bus.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <rover/tick_t.hpp>
#include <rover/truth_t.hpp>

#include "common/bus/channels.hpp"
#include "common/bus/streams.hpp"
#include "common/bus/vehicle_config.hpp"
#include "rover_simulator/setup.hpp"
#include "rover_simulator/simulator.hpp"

namespace rover {
namespace {

const std::string kConfig = std::string(ROVER_SOURCE_DIR) + "/config";
using Bytes = std::vector<std::uint8_t>;

// Answers each tick on every channel that the simulator subscribes to, optionally preceded by invalid copies.
class Participant {
 public:
  Participant(lcm::LCM& bus, bool disturbs) : bus_(bus), disturbs_(disturbs), streams_("participant", 1) {
    bus_.subscribeFunction(
        channel::kTick,
        +[](const lcm::ReceiveBuffer* buffer, const std::string&, Participant* participant) {
          tick_t tick;
          if (decode_message(buffer->data, static_cast<int>(buffer->data_size), tick))
            participant->answer(tick.header.utime);
        },
        this);
    publish_done(kNever);
  }
  const std::map<std::string, std::int64_t>& sent() const { return sent_; }

 private:
  void answer(Utime t) {
    wheel_command_t command{};
    command.valid_until_utime = t + 10 * kTickUs;
    for (double& rate : command.drive_rate_radps) rate = 1.0;
    send(channel::kWheelCommand, command, t);
    ptu_command_t look{};
    look.pan_rad = 0.1;
    send(channel::kPtuCommand, look, t);
    supervisor_state_t state{};
    state.state = supervisor_state_t::DRIVING;
    send(channel::kState, state, t);
    publish_done(t);
  }

  void publish_done(Utime t) {
    done_t done{};
    done.tick_utime = t;
    done.promise_utime = kNever;
    done.pid = getpid();
    send(channel::kDone, done, t);
  }

  template <class Message>
  void send(const char* channel, Message& message, Utime t) {
    message.header = streams_.next(channel, t, t + kTickUs);
    const Bytes good = encoded(message);
    if (disturbs_) {
      put_bad(channel, {});
      put_bad(channel, Bytes(100, 0xA5));
      put_bad(channel, {good.begin(), good.begin() + 20});
      put_bad(channel, {good.begin(), good.end() - 1});
      tick_t foreign{};
      foreign.header = message.header;
      put_bad(channel, encoded(foreign));
    }
    put(channel, good);
  }

  void put_bad(const char* channel, const Bytes& bytes) {
    ++sent_[channel];
    put(channel, bytes);
  }
  void put(const char* channel, const Bytes& bytes) {
    bus_.publish(channel, bytes.data(), static_cast<unsigned int>(bytes.size()));
  }

  lcm::LCM& bus_;
  bool disturbs_;
  StreamCounter streams_;
  std::map<std::string, std::int64_t> sent_;
};

struct Drive {
  SimulationSummary summary;
  std::vector<Bytes> truth;
  std::map<std::string, std::int64_t> malformed, sent;
  std::string log;
};

// One second on a plane.
Drive drive(bool disturbed) {
  SimulatedRoverConfig config;
  config.navcam = load_stereo_rig(kConfig, "navcam");
  config.loccam.scene.fine_radius_m = 4.5;
  config.loccam.scene.middle_radius_m = 8.0;
  config.loccam.scene.far_radius_m = 30.0;
  auto world = std::make_unique<World>(WorldConfig{}, plane_raster(40.0, 40.0, 1.0, 0.0, 0.0), 1);
  SimulatedRover rover(config, load_vehicle(kConfig), load_stereo_rig(kConfig, "loccam"), std::move(world),
                       {20.0, 20.0, 0.0}, 1);
  SimulatorOptions options;
  options.participants = {"participant"};
  options.end.timeout_s = 1.0;
  Drive drive;
  lcm::LCM bus("memq://");
  bus.subscribeFunction(
      channel::kTruth,
      +[](const lcm::ReceiveBuffer* buffer, const std::string&, std::vector<Bytes>* truth) {
        const auto* begin = static_cast<const std::uint8_t*>(buffer->data);
        truth->emplace_back(begin, begin + buffer->data_size);
      },
      &drive.truth);
  testing::internal::CaptureStdout();
  Simulator simulator(options, rover, bus);
  const Participant participant(bus, disturbed);
  drive.summary = simulator.run([] { return true; });
  drive.log = testing::internal::GetCapturedStdout();
  drive.malformed = simulator.malformed();
  drive.sent = participant.sent();
  return drive;
}

TEST(SimulatorNode, InvalidMessagesAreCountedAndIgnored) {
  const Drive calm = drive(false);
  const Drive disturbed = drive(true);
  EXPECT_EQ(calm.summary.outcome, "timeout");
  EXPECT_EQ(disturbed.summary.outcome, "timeout");
  EXPECT_TRUE(disturbed.summary.left.empty());
  ASSERT_GE(calm.truth.size(), 50u);
  EXPECT_TRUE(disturbed.truth == calm.truth);
  ASSERT_GE(disturbed.malformed.size(), 4u);
  // Fails if a new subscription of the simulator is not covered by this test.
  EXPECT_EQ(disturbed.malformed, disturbed.sent);
  for (const auto& [channel, count] : disturbed.malformed)
    EXPECT_NE(disturbed.log.find("BAD_MESSAGE channel=" + channel + " count=1\n"), std::string::npos) << disturbed.log;
  for (const auto& [channel, count] : calm.malformed) EXPECT_EQ(count, 0) << channel;
}

TEST(SimulatedRover, StandsOnCertifiedGroundAlsoIfItsStartIsBadlyKnown) {
  Scenario scenario = load_scenario(kConfig + "/scenarios/plain.yaml");
  scenario.world.rocks.k = 0.12;  // its own rocks are too few to stand on any
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto rover = make_simulated_rover(scenario, kConfig, seed);
    const Eigen::Vector3d at = rover->T_map_body().translation();
    const std::vector<Rock> rocks = rover->world().rocks_in(at.x() - 2.0, at.y() - 2.0, at.x() + 2.0, at.y() + 2.0);
    EXPECT_TRUE(std::none_of(rocks.begin(), rocks.end(), [&](const Rock& rock) {
      return rock.height_m >= 0.12 && std::hypot(rock.x_m - at.x(), rock.y_m - at.y()) < scenario.start.clear_radius_m;
    })) << seed;
  }
}

}  // namespace
}  // namespace rover
