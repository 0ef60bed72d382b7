// NavCam on its pan-tilt unit, on an in-memory bus in lockstep.
#include <gtest/gtest.h>

#include <rover/image_t.hpp>
#include <rover/ptu_state_t.hpp>
#include <rover/tick_t.hpp>

#include "common/bus/channels.hpp"
#include "common/bus/streams.hpp"
#include "common/bus/vehicle_config.hpp"
#include "rover_simulator/simulator.hpp"

namespace rover {
namespace {

const std::string kRigConfig = std::string(ROVER_SOURCE_DIR) + "/config";
using MessageBytes = std::vector<std::uint8_t>;

// Publishes PTU_COMMAND at given ticks, counted from the first.
class Looker {
 public:
  struct Order {
    int tick;
    double pan_rad;
    double tilt_rad;
    bool take_image;
  };
  Looker(lcm::LCM& bus, std::vector<Order> orders) : bus_(bus), orders_(std::move(orders)), streams_("looker", 1) {
    bus_.subscribeFunction(
        channel::kTick,
        +[](const lcm::ReceiveBuffer* buffer, const std::string&, Looker* looker) {
          tick_t tick;
          if (decode_message(buffer->data, static_cast<int>(buffer->data_size), tick))
            looker->answer(tick.header.utime);
        },
        this);
    publish_done(kNever);
  }

 private:
  void answer(Utime t) {
    for (const Order& order : orders_) {
      if (order.tick != ticks_) continue;
      ptu_command_t command{};
      command.pan_rad = order.pan_rad;
      command.tilt_rad = order.tilt_rad;
      command.take_image = order.take_image ? 1 : 0;
      command.header = streams_.next(channel::kPtuCommand, t, t + kTickUs);
      bus_.publish(channel::kPtuCommand, &command);
    }
    ++ticks_;
    publish_done(t);
  }
  void publish_done(Utime t) {
    done_t done{};
    done.tick_utime = t;
    done.promise_utime = kNever;
    done.pid = getpid();
    done.streams = streams_.take_updated();
    done.stream_count = static_cast<std::int32_t>(done.streams.size());
    done.header = reports_.next(channel::kDone, t, t + kTickUs);
    bus_.publish(channel::kDone, &done);
  }

  lcm::LCM& bus_;
  std::vector<Order> orders_;
  StreamCounter streams_;
  StreamCounter reports_{"looker", 1};
  int ticks_ = 0;
};

struct Seen {
  std::vector<MessageBytes> everything;  // of all channels, in the order of publication
  std::vector<ptu_state_t> states;
  std::vector<image_t> left, right, loccam;
};

template <class Message>
void collect(lcm::LCM& bus, const char* channel, std::vector<Message>& out) {
  bus.subscribeFunction(
      channel,
      +[](const lcm::ReceiveBuffer* buffer, const std::string&, std::vector<Message>* messages) {
        Message message;
        if (decode_message(buffer->data, static_cast<int>(buffer->data_size), message)) messages->push_back(message);
      },
      &out);
}

// On a smooth plane.
Seen look(std::vector<Looker::Order> orders, double seconds, std::vector<ScriptedFault> faults = {}) {
  SimulatedRoverConfig config;
  config.navcam = load_stereo_rig(kRigConfig, "navcam");
  config.loccam.scene.fine_radius_m = 4.5;
  config.loccam.scene.middle_radius_m = 8.0;
  config.loccam.scene.far_radius_m = 30.0;
  auto world = std::make_unique<World>(WorldConfig{}, plane_raster(40.0, 40.0, 1.0, 0.0, 0.0), 1);
  SimulatedRover rover(config, load_vehicle(kRigConfig), load_stereo_rig(kRigConfig, "loccam"), std::move(world),
                       {20.0, 20.0, 0.0}, 1);
  SimulatorOptions options;
  options.participants = {"looker"};
  options.end.timeout_s = seconds;
  options.faults = std::move(faults);
  Seen recorded;
  lcm::LCM bus("memq://");
  collect(bus, channel::kPtuState, recorded.states);
  collect(bus, channel::kNavCamLeft, recorded.left);
  collect(bus, channel::kNavCamRight, recorded.right);
  collect(bus, channel::kLocCamLeft, recorded.loccam);
  bus.subscribeFunction(
      ".*",
      +[](const lcm::ReceiveBuffer* buffer, const std::string&, std::vector<MessageBytes>* all) {
        const auto* begin = static_cast<const std::uint8_t*>(buffer->data);
        all->emplace_back(begin, begin + buffer->data_size);
      },
      &recorded.everything);
  testing::internal::CaptureStdout();
  Simulator simulator(options, rover, bus);
  const Looker looker(bus, std::move(orders));
  const SimulationSummary summary = simulator.run([] { return true; });
  testing::internal::GetCapturedStdout();
  EXPECT_TRUE(summary.deterministic);
  return recorded;
}

TEST(NavCam, IsSilentUntilFirstPtuCommand) {
  const Seen recorded = look({}, 1.0);
  EXPECT_TRUE(recorded.states.empty());
  EXPECT_TRUE(recorded.left.empty());
  EXPECT_GE(recorded.loccam.size(), 2u);
}

TEST(NavCam, PairIsExposedAfterUnitReachesCommandedAngles) {
  const Seen recorded = look({{2, to_rad(8.0), to_rad(3.0), true}}, 1.2);
  ASSERT_EQ(recorded.left.size(), 1u);
  ASSERT_EQ(recorded.right.size(), 1u);
  EXPECT_EQ(recorded.left[0].width, 640);
  EXPECT_EQ(recorded.left[0].header.utime, recorded.right[0].header.utime);
  EXPECT_EQ(recorded.left[0].header.release_utime - recorded.left[0].header.utime, 60'000);
  EXPECT_NE(recorded.left[0].data, recorded.right[0].data);
  // 8 deg at 20 deg/s, from the command's release on; a state each tick.
  ASSERT_GT(recorded.states.size(), 40u);
  const Utime begin = recorded.states.front().header.utime;
  EXPECT_EQ(recorded.left[0].header.utime - begin, 380'000);
  for (size_t i = 0; i < recorded.states.size(); ++i) {
    const ptu_state_t& state = recorded.states[i];
    EXPECT_EQ(state.header.utime, begin + static_cast<Utime>(i) * kTickUs);
    EXPECT_EQ(state.moving != 0, state.header.utime < recorded.left[0].header.utime);
  }
  EXPECT_NEAR(recorded.states.back().pan_rad, to_rad(8.0), 1e-12);
  EXPECT_NEAR(recorded.states.back().tilt_rad, to_rad(3.0), 1e-12);
}

TEST(NavCam, IsDeterministicByteForByte) {
  const std::vector<Looker::Order> orders = {{1, 0.1, 0.0, true}, {20, 0.1, 0.05, true}, {21, 0.0, 0.0, true}};
  const Seen once = look(orders, 1.0), again = look(orders, 1.0);
  EXPECT_GE(once.left.size(), 2u);
  EXPECT_TRUE(once.everything == again.everything);
}

TEST(NavCam, DoesNotChangeLocCamImages) {
  const Seen without = look({}, 1.3);
  const Seen with = look({{1, 0.2, 0.0, true}, {30, 0.0, 0.1, true}}, 1.3);
  ASSERT_EQ(with.loccam.size(), without.loccam.size());
  ASSERT_EQ(with.left.size(), 2u);
  for (size_t i = 0; i < with.loccam.size(); ++i) EXPECT_EQ(with.loccam[i].data, without.loccam[i].data) << i;
}

TEST(NavCam, HasIndependentCameraFaults) {
  ScriptedFault blind;
  blind.order = {"camera_blind", "navcam_left"};
  blind.at_s = 0.0;
  const Seen recorded = look({{1, 0.0, 0.0, true}}, 0.6, {blind});
  ASSERT_EQ(recorded.left.size(), 1u);
  const auto black = [](const image_t& image) {
    return std::all_of(image.data.begin(), image.data.end(), [](int grey) { return grey == 0; });
  };
  EXPECT_TRUE(black(recorded.left[0]));
  EXPECT_FALSE(black(recorded.right[0]));
  EXPECT_FALSE(black(recorded.loccam[0]));
}

}  // namespace
}  // namespace rover
