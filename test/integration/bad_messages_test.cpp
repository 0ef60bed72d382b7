// Malformed messages on every subscribed channel of every node: each is counted and logged, and nothing else changes.
//
// All nodes run together once with a stationary rover, and all messages are recorded. Then each node runs alone on the
// recorded inputs: once unchanged, and once with malformed copies before valid messages. The channels come from the
// node's heartbeat, so new subscriptions are covered automatically.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <rover/cloud_t.hpp>
#include <rover/correction_t.hpp>
#include <rover/elevation_t.hpp>
#include <rover/fault_t.hpp>
#include <rover/image_t.hpp>
#include <rover/imu_t.hpp>
#include <rover/injection_t.hpp>
#include <rover/ptu_state_t.hpp>
#include <rover/slam_pose_t.hpp>
#include <rover/supervisor_state_t.hpp>
#include <rover/traversability_t.hpp>
#include <rover/wheel_state_t.hpp>
#include <set>
#include <sstream>

#include "common/bus/channel_types.hpp"
#include "common/bus/convert.hpp"
#include "common/bus/node.hpp"
#include "common/bus/vehicle_config.hpp"
#include "global_localization/node.hpp"
#include "hazard_detector/node.hpp"
#include "localization/config.hpp"
#include "localization/node.hpp"
#include "locomotion/node.hpp"
#include "mission_control/node.hpp"
#include "pan_tilt/node.hpp"
#include "path_planner/config.hpp"
#include "path_planner/node.hpp"
#include "point_cloud/node.hpp"
#include "recorder/node.hpp"
#include "slam/node.hpp"
#include "stereo/node.hpp"
#include "supervisor/config.hpp"
#include "supervisor/node.hpp"
#include "test/recorder/read_back.hpp"
#include "test/stereo/synthetic_world.hpp"
#include "trajectory_control/config.hpp"
#include "trajectory_control/node.hpp"
#include "traversability/node.hpp"
#include "visual_odometry/config.hpp"
#include "visual_odometry/node.hpp"

namespace rover {
namespace {

namespace fs = std::filesystem;

const std::string kConfig = std::string(ROVER_SOURCE_DIR) + "/config";
constexpr Utime kStart = 1'000'000;
constexpr Utime kEnd = kStart + 14'000'000;  // static alignment takes 10 s; a tick with heartbeats
constexpr Utime kFramePeriod = 400'000;
constexpr Utime kCameraLatency = 60'000;

using Bytes = std::vector<std::uint8_t>;
using Factory = std::function<std::shared_ptr<void>(Node&)>;

std::shared_ptr<void> make_test_recorder(Node& node) {
  return std::make_shared<recorder::RecorderNode>(node, recorder::load_config(kConfig),
                                                  node.options().run_dir + "/traverse.lcm",
                                                  [] { return std::uintmax_t{100'000'000'000}; });
}

MissionPlan plan() {
  MissionPlan plan;
  plan.start.pose = {20.0, 20.0, 0.0};
  plan.path.x_m = {20.0, 25.0, 30.0};
  plan.path.y_m = {20.0, 20.0, 20.0};
  plan.path.level = {0, 0, 0};
  return plan;
}

// Without the rows that detect malformed messages.
supervisor::SupervisorConfig supervisor_config() {
  supervisor::SupervisorConfig config = supervisor::load_config(kConfig);
  std::erase_if(config.fdir.lines, [](const auto& line) { return line.quantity == "message_loss_ratio"; });
  return config;
}

const std::map<std::string, Factory>& factories() {
  static const std::map<std::string, Factory> kFactories = {
      {"stereo", [](Node& n) { return stereo::make_stereo(n, kConfig); }},
      {"visual_odometry", [](Node& n) { return std::make_shared<vo::OdometryNode>(n, vo::load_config(kConfig)); }},
      {"localization",
       [](Node& n) {
         return std::make_shared<loc::LocalizationNode>(n, loc::load_config(kConfig), load_vehicle(kConfig));
       }},
      {"hazard_detector", [](Node& n) { return hazard::make_hazard_detector(n, kConfig); }},
      {"path_planner",
       [](Node& n) { return std::make_shared<planning::PathPlannerNode>(n, planning::load_config(kConfig)); }},
      {"trajectory_control",
       [](Node& n) { return std::make_shared<control::TrajectoryControlNode>(n, control::load_config(kConfig)); }},
      {"locomotion",
       [](Node& n) { return std::make_shared<locomotion::LocomotionNode>(n, locomotion::load_config(kConfig)); }},
      {"supervisor",
       [](Node& n) {
         return std::make_shared<supervisor::SupervisorNode>(n, supervisor_config(),
                                                             [](const std::string&, const char*) { return false; });
       }},
      {"mission_control", [](Node& n) { return std::make_shared<MissionControlNode>(n, plan()); }},
      {"recorder", make_test_recorder},
      {"global_localization", [](Node& n) { return global::make_global_localization(n, kConfig); }},
      {"slam", [](Node& n) { return slam::make_slam(n, kConfig); }},
      {"traversability", [](Node& n) { return trav::make_traversability(n, kConfig); }},
      {"point_cloud", [](Node& n) { return cloud::make_point_cloud(n, kConfig); }},
      {"pan_tilt", [](Node& n) { return gaze::make_pan_tilt(n, kConfig); }},
  };
  return kFactories;
}

std::vector<std::string> names_of_all() {
  std::vector<std::string> names;
  for (const auto& [name, factory] : factories()) names.push_back(name);
  return names;
}

struct Event {
  std::string channel;
  Bytes bytes;
};

header_t header_of(const Event& event) {
  header_t header{};
  peek_header(event.bytes.data(), static_cast<int>(event.bytes.size()), header);
  return header;
}

// An in-memory bus that records all messages.
class Bus {
 public:
  Bus() : lcm_("memq://") {
    lcm_.subscribeFunction(
        ".*",
        +[](const lcm::ReceiveBuffer* buffer, const std::string& channel, std::vector<Event>* events) {
          const auto* begin = static_cast<const std::uint8_t*>(buffer->data);
          events->push_back({channel, {begin, begin + buffer->data_size}});
        },
        &recorded_);
  }
  lcm::LCM& lcm() { return lcm_; }
  void publish(const Event& event) {
    lcm_.publish(event.channel, event.bytes.data(), static_cast<unsigned int>(event.bytes.size()));
  }
  void drain(const std::vector<Node*>& nodes) {
    while (lcm_.handleTimeout(0) > 0)
      for (Node* node : nodes) node->handle(0);
    for (Node* node : nodes) node->handle(0);
  }
  const std::vector<Event>& recorded() const { return recorded_; }

 private:
  lcm::LCM lcm_;
  std::vector<Event> recorded_;
};

// Sensors of a stationary rover, and measurements of the Full level, whose services idle.
class StandingWorld {
 public:
  explicit StandingWorld(Bus& bus) : bus_(bus), streams_("world", 1) {
    const synthetic::RawPair pair = synthetic::render({}, synthetic::loccam_rig(), 1.0, 5);
    image_to(pair.left, left_);
    image_to(pair.right, right_);
    const synthetic::RawPair far = synthetic::render({}, load_stereo_rig(kConfig, "navcam"), 1.0, 5);
    image_to(far.left, navcam_left_);
    image_to(far.right, navcam_right_);
  }

  void publish_sensors(Utime t) {
    constexpr double kMarsGravity = 3.71;
    std::uniform_real_distribution<double> noise(-1e-5, 1e-5);  // a real sensor never repeats itself
    imu_t imu{};
    imu.dt_s = to_seconds(kTickUs);
    for (double& angle : imu.delta_angle_rad) angle = noise(random_);
    for (double& velocity : imu.delta_velocity_mps) velocity = noise(random_);
    imu.delta_velocity_mps[2] += kMarsGravity * imu.dt_s;
    imu.fog_delta_yaw_rad = noise(random_);
    send(channel::kImu, imu, t, t);
    wheel_state_t wheels{};
    send(channel::kWheelState, wheels, t, t);
    ptu_state_t unit{};
    send(channel::kPtuState, unit, t, t);
    if ((t - kStart) % kFramePeriod != 0) return;
    left_.data.back() ^= 1;  // noise: identical images count as a frozen camera
    right_.data.back() ^= 1;
    send(channel::kLocCamLeft, left_, t, t + kCameraLatency);
    send(channel::kLocCamRight, right_, t, t + kCameraLatency);
    navcam_left_.data.back() ^= 1;
    navcam_right_.data.back() ^= 1;
    send(channel::kNavCamLeft, navcam_left_, t, t + kCameraLatency);
    send(channel::kNavCamRight, navcam_right_, t, t + kCameraLatency);
    slam_pose_t slam{};
    slam.status = slam_pose_t::NO_INFORMATION;
    send(channel::kSlamPose, slam, t, t);
    traversability_t terrain{};
    send(channel::kTraversability, terrain, t, t);
    fault_t fault{};
    send(channel::kFault, fault, t, t);
    correction_t correction{};
    send(channel::kCorrection, correction, t, t);
    publish_full(t);
    injection_t injection{};
    injection.target = "NO_SUCH_CHANNEL";
    injection.fault = "drop";
    send(channel::kInject, injection, t, t);
  }

  void publish_full(Utime t) {
    ptu_state_t unit{};
    send(channel::kPtuState, unit, t, t);
    image_t picture{};
    picture.width = 640;
    picture.height = 480;
    picture.size = picture.width * picture.height;
    picture.data.assign(static_cast<size_t>(picture.size), 90);
    send(channel::kNavCamLeft, picture, t, t);
    send(channel::kNavCamRight, picture, t, t);
    cloud_t cloud{};
    cloud.point_count = 1;
    cloud.x_m = cloud.y_m = cloud.depth_sigma_m = {0.1f};
    cloud.z_m = {3.0f};
    send(channel::kCloud, cloud, t, t);
    elevation_t map{};
    map.cell_m = 0.1;
    map.cells_x = map.cells_y = 1;
    map.size = 1;
    map.height_m = map.sigma_m = {0.1f};
    send(channel::kElevation, map, t, t);
  }

  void give_tick(Utime t) {
    std::map<std::tuple<std::string, std::string, std::int64_t>, std::int64_t> grown;
    for (; listed_ < bus_.recorded().size(); ++listed_) {
      const Event& event = bus_.recorded()[listed_];
      if (event.channel == channel::kDone) continue;  // uses a separate port on a real bus
      const header_t header = header_of(event);
      grown[{event.channel, header.publisher, header.boot_id}] = header.seq;
    }
    tick_t tick{};
    tick.mode = tick_t::LOCKSTEP;
    tick.members = names_of_all();
    tick.member_count = static_cast<std::int32_t>(tick.members.size());
    for (const auto& [key, seq] : grown) {
      stream_seq_t stream;
      std::tie(stream.channel, stream.publisher, stream.boot_id) = key;
      stream.seq = seq;
      tick.streams.push_back(stream);
    }
    tick.stream_count = static_cast<std::int32_t>(tick.streams.size());
    send(channel::kTick, tick, t, t);
  }

 private:
  template <class Message>
  void send(const char* channel, Message& message, Utime utime, Utime release) {
    message.header = streams_.next(channel, utime, release);
    bus_.lcm().publish(channel, &message);
  }

  Bus& bus_;
  StreamCounter streams_;
  std::mt19937_64 random_{1};
  image_t left_{}, right_{};
  image_t navcam_left_{}, navcam_right_{};
  size_t listed_ = 0;  // of the recorded messages, in ticks
};

fs::path fresh_folder(const std::string& name) {
  const fs::path dir = fs::path(testing::TempDir()) / ("bad_messages_" + std::to_string(getpid())) / name;
  fs::remove_all(dir);
  fs::create_directories(dir);
  return dir;
}

NodeOptions options_of(const std::string& name, const fs::path& run_dir) {
  NodeOptions options;
  options.name = name;
  options.run_dir = run_dir;
  options.allow_injection = true;  // so that INJECT is among the inputs
  return options;
}

// All messages of the whole stack.
std::vector<Event> run_together() {
  const fs::path run_dir = fresh_folder("together");
  Bus bus;
  std::vector<std::unique_ptr<Node>> owners;
  std::vector<std::shared_ptr<void>> services;
  std::vector<Node*> nodes;
  for (const auto& [name, factory] : factories()) {
    owners.push_back(std::make_unique<Node>(options_of(name, run_dir), bus.lcm()));
    services.push_back(factory(*owners.back()));
    nodes.push_back(owners.back().get());
  }
  StandingWorld world(bus);
  for (Utime t = kStart; t <= kEnd; t += kTickUs) {
    world.publish_sensors(t);
    bus.drain(nodes);
    world.give_tick(t);
    bus.drain(nodes);
  }
  // Messages after the last tick belong to no other tick.
  std::vector<Event> recorded = bus.recorded();
  while (recorded.back().channel != channel::kTick) recorded.pop_back();
  return recorded;
}

// Malformed copies of the message. None is of the channel's type.
std::vector<Bytes> bad_copies(const Event& event, const Event& foreign) {
  const Bytes& good = event.bytes;
  const auto body = static_cast<std::ptrdiff_t>(kFingerprintBytes + header_of(event)._getEncodedSizeNoHash());
  std::vector<Bytes> copies = {
      {},                                                     // empty
      Bytes(100, 0xA5),                                       // noise
      {good.begin(), good.begin() + 5},                       // cut in the fingerprint
      {good.begin(), good.begin() + kFingerprintBytes + 20},  // cut in the header
      {good.begin(), good.begin() + body},                    // only the header
      {good.begin(), good.end() - 1},                         // cut at the end
      good,                                                   // one trailing byte, added below
      foreign.bytes,                                          // of another type
  };
  copies[6].push_back(0);
  // All content bits set: lengths of -1. Without lengths this is still a valid message.
  Bytes damaged = good;
  std::fill(damaged.begin() + body, damaged.end(), std::uint8_t{0xFF});
  const ChannelType* type = find_channel_type(event.channel);
  if (!type->decodes(damaged.data(), static_cast<int>(damaged.size()))) copies.push_back(damaged);
  return copies;
}

// Results of a node: its messages in order, its files, and its input counters.
struct Traces {
  std::vector<Event> said;
  std::map<std::string, Bytes> files;
  std::vector<heartbeat_t> heartbeats;  // without process figures
  std::string log;
};

bool is_own_heartbeat(const Event& event, const std::string& name) {
  return event.channel == channel::kHeartbeat && header_of(event).publisher == name;
}

std::map<std::string, Bytes> files_in(const fs::path& dir, const std::string& name) {
  std::map<std::string, Bytes> files;
  for (const auto& entry : fs::directory_iterator(dir)) {
    std::ifstream in(entry.path(), std::ios::binary);
    Bytes& bytes = files[entry.path().filename()];
    if (entry.path().extension() != ".lcm") {
      bytes.assign(std::istreambuf_iterator<char>(in), {});
      continue;
    }
    // The log without the recorder's heartbeats, which contain CPU times.
    for (const recorder::ReadBack& record : recorder::read_back(entry.path())) {
      if (is_own_heartbeat({record.channel, record.bytes}, name)) continue;
      bytes.insert(bytes.end(), record.channel.begin(), record.channel.end());
      bytes.insert(bytes.end(), record.bytes.begin(), record.bytes.end());
    }
  }
  return files;
}

Traces traces_of(const std::string& name, const std::vector<Event>& recorded) {
  Traces traces;
  for (const Event& event : recorded) {
    if (header_of(event).publisher != name) continue;
    if (event.channel != channel::kHeartbeat) {
      traces.said.push_back(event);
      continue;
    }
    heartbeat_t heartbeat;
    decode_message(event.bytes.data(), static_cast<int>(event.bytes.size()), heartbeat);
    heartbeat.cpu_s = heartbeat.rss_mb = heartbeat.step_p50_ms = heartbeat.step_p99_ms = 0.0;
    traces.heartbeats.push_back(heartbeat);
  }
  return traces;
}

// Number of malformed messages by channel.
using Sent = std::map<std::string, std::int64_t>;

// Publishes malformed copies before the first messages of each channel and some later ones.
class Disturbance {
 public:
  Disturbance(const std::string& name, std::set<std::string> channels, const std::vector<Event>& all)
      : channels_(std::move(channels)) {
    for (const Event& event : all)
      if (header_of(event).publisher != name) samples_.try_emplace(event.channel, event);
  }
  void before(const Event& event, Bus& bus) {
    if (!channels_.contains(event.channel)) return;
    constexpr std::int64_t kFirst = 3, kEach = 25;
    const std::int64_t n = seen_[event.channel]++;
    if (n >= kFirst && n % kEach != 0) return;
    for (Bytes& bad : bad_copies(event, foreign_to(event.channel))) {
      bus.publish({event.channel, std::move(bad)});
      ++sent_[event.channel];
    }
  }
  const Sent& sent() const { return sent_; }

 private:
  const Event& foreign_to(const std::string& channel) const {
    const std::int64_t fingerprint = find_channel_type(channel)->fingerprint;
    for (const auto& [other, sample] : samples_)
      if (find_channel_type(other)->fingerprint != fingerprint) return sample;
    throw std::logic_error("one type only");
  }

  std::set<std::string> channels_;
  std::map<std::string, Event> samples_;
  std::map<std::string, std::int64_t> seen_;
  Sent sent_;
};

// Runs one node on the recorded messages of the others.
Traces run_alone(const std::string& name, const std::vector<Event>& all, Disturbance* disturbance) {
  const fs::path run_dir = fresh_folder(name);
  testing::internal::CaptureStdout();
  Traces traces;
  {
    Bus bus;
    Node node(options_of(name, run_dir), bus.lcm());
    const std::shared_ptr<void> service = factories().at(name)(node);
    for (const Event& event : all) {
      if (header_of(event).publisher == name) continue;
      if (disturbance != nullptr) disturbance->before(event, bus);
      bus.publish(event);
      if (event.channel == channel::kTick) bus.drain({&node});
    }
    traces = traces_of(name, bus.recorded());
  }
  traces.log = testing::internal::GetCapturedStdout();
  traces.files = files_in(run_dir, name);
  return traces;
}

class BadMessages : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!all_.empty()) return;
    testing::internal::CaptureStdout();
    all_ = run_together();
    testing::internal::GetCapturedStdout();
  }
  static void TearDownTestSuite() { fs::remove_all(fresh_folder("").parent_path()); }

  static inline std::vector<Event> all_;
};

class EachNode : public BadMessages, public testing::WithParamInterface<std::string> {};

// Subscribed channels of a node, from its heartbeat; ".*": all.
std::set<std::string> inputs_of(const Traces& traces, const std::vector<Event>& all, const std::string& name) {
  std::set<std::string> channels;
  for (const input_health_t& input : traces.heartbeats.back().inputs) {
    if (input.channel != ".*") {
      channels.insert(input.channel);
      continue;
    }
    for (const Event& event : all)
      if (header_of(event).publisher != name && event.channel != channel::kDone) channels.insert(event.channel);
  }
  return channels;
}

TEST_P(EachNode, CountsAndNamesBadMessagesAndNothingElseChanges) {
  const std::string name = GetParam();
  const Traces calm = run_alone(name, all_, nullptr);
  ASSERT_FALSE(calm.heartbeats.empty()) << calm.log;
  const std::set<std::string> channels = inputs_of(calm, all_, name);
  ASSERT_TRUE(channels.contains(channel::kTick));
  ASSERT_GE(channels.size(), 3u) << name << " subscribes to nothing but TICK and INJECT";

  Disturbance disturbance(name, channels, all_);
  const Traces disturbed = run_alone(name, all_, &disturbance);
  for (const std::string& channel : channels) {
    EXPECT_TRUE(disturbance.sent().contains(channel))
        << "nobody publishes " << channel << " while all run together: let StandingWorld do it";
    EXPECT_NE(disturbed.log.find("WARN " + name + " BAD_MESSAGE channel=" + channel + " count=1 why="),
              std::string::npos)
        << channel << " is not named in:\n"
        << disturbed.log;
  }

  ASSERT_EQ(disturbed.said.size(), calm.said.size());
  for (size_t i = 0; i < calm.said.size(); ++i) {
    ASSERT_EQ(disturbed.said[i].channel, calm.said[i].channel) << i;
    ASSERT_EQ(disturbed.said[i].bytes, calm.said[i].bytes) << calm.said[i].channel << " differs, message " << i;
  }
  ASSERT_EQ(disturbed.files.size(), calm.files.size());
  for (const auto& [file, bytes] : calm.files) EXPECT_TRUE(disturbed.files.at(file) == bytes) << file << " differs";

  ASSERT_EQ(disturbed.heartbeats.size(), calm.heartbeats.size());
  for (size_t i = 0; i < calm.heartbeats.size(); ++i) {
    EXPECT_EQ(disturbed.heartbeats[i].status, calm.heartbeats[i].status) << i;
    EXPECT_EQ(disturbed.heartbeats[i].text, calm.heartbeats[i].text) << i;
  }
  const heartbeat_t& before = calm.heartbeats.back();
  const heartbeat_t& after = disturbed.heartbeats.back();
  ASSERT_EQ(after.inputs.size(), before.inputs.size());
  for (size_t i = 0; i < before.inputs.size(); ++i) {
    const input_health_t& input = after.inputs[i];
    EXPECT_GT(input.received, 0) << input.channel;
    EXPECT_EQ(input.received, before.inputs[i].received) << input.channel;
    EXPECT_EQ(input.last_utime, before.inputs[i].last_utime) << input.channel;
    EXPECT_EQ(input.gaps, before.inputs[i].gaps) << input.channel;
    EXPECT_EQ(input.out_of_order, before.inputs[i].out_of_order) << input.channel;
    std::int64_t sent = 0;
    for (const auto& [channel, count] : disturbance.sent())
      if (input.channel == channel || input.channel == ".*") sent += count;
    EXPECT_EQ(input.malformed - before.inputs[i].malformed, sent) << input.channel;
  }
}

INSTANTIATE_TEST_SUITE_P(Stack, EachNode, testing::ValuesIn(names_of_all()),
                         [](const auto& test) { return test.param; });

// The recorded inputs contain all phases of a drive.
TEST_F(BadMessages, AreSentWhileTheRoverDrives) {
  const auto drives = [](const Event& event) {
    supervisor_state_t state;
    return event.channel == channel::kState &&
           decode_message(event.bytes.data(), static_cast<int>(event.bytes.size()), state) &&
           state.state == supervisor_state_t::DRIVING;
  };
  EXPECT_TRUE(std::any_of(all_.begin(), all_.end(), drives));
}

// The list of nodes comes from the build.
TEST(BadMessagesTable, HoldsEveryNode) {
  std::istringstream built(ROVER_NODES);
  for (std::string name; std::getline(built, name, ',');) EXPECT_TRUE(factories().contains(name)) << name;
}

TEST(ChannelTypes, EveryChannelHasOne) {
  std::ifstream header(std::string(ROVER_SOURCE_DIR) + "/services/common/bus/channels.hpp");
  int count = 0;
  for (std::string line; std::getline(header, line);) {
    const size_t begin = line.find('"');
    if (line.rfind("inline constexpr char k", 0) != 0 || begin == std::string::npos) continue;
    const std::string channel = line.substr(begin + 1, line.find('"', begin + 1) - begin - 1);
    EXPECT_NE(find_channel_type(channel), nullptr) << channel;
    ++count;
  }
  EXPECT_GT(count, 30);
}

}  // namespace
}  // namespace rover
