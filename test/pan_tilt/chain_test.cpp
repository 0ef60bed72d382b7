// pan_tilt, the simulator's NavCam and point_cloud on an in-memory bus, in lockstep: a sweep, then a drive.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <rover/cloud_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/tick_t.hpp>
#include <rover/truth_t.hpp>

#include "common/bus/convert.hpp"
#include "common/bus/vehicle_config.hpp"
#include "pan_tilt/node.hpp"
#include "point_cloud/node.hpp"
#include "rover_simulator/simulator.hpp"

namespace rover {
namespace {

const std::string kConfig = std::string(ROVER_SOURCE_DIR) + "/config";
constexpr double kSweepS = 17.0;
constexpr double kDriveS = 6.0;

// Replaces supervisor, localization (true pose), planner and locomotion: sweeps, then drives straight ahead.
class Driver {
 public:
  explicit Driver(lcm::LCM& bus) : bus_(bus) {
    bus_.subscribe(channel::kTruth, &Driver::on_truth, this);
    bus_.subscribe(channel::kTick, &Driver::on_tick, this);
    send_done(kNever);
  }
  const std::map<Utime, Eigen::Isometry3d>& poses() const { return poses_; }

 private:
  void on_truth(const lcm::ReceiveBuffer*, const std::string&, const truth_t* truth) {
    const Eigen::Isometry3d T = pose_from(truth->position_map_body_m, truth->quat_map_body_wxyz);
    if (!poses_.empty()) travelled_m_ += (T.translation() - poses_.rbegin()->second.translation()).head<2>().norm();
    poses_[truth->header.utime] = T;
  }
  void on_tick(const lcm::ReceiveBuffer*, const std::string&, const tick_t* tick) {
    const Utime t = tick->header.utime;
    if (first_ == kNever) first_ = t;
    const bool sweeps = to_seconds(t - first_) < kSweepS;
    supervisor_state_t state{};
    state.level = supervisor_state_t::FULL;
    state.state = sweeps ? supervisor_state_t::SWEEPING : supervisor_state_t::DRIVING;
    send(channel::kState, state, t);
    pose_t pose{};
    pose_to(poses_.at(t), pose.position_odom_body_m, pose.quat_odom_body_wxyz);
    pose.travelled_m = travelled_m_;
    send(channel::kPose, pose, t);
    wheel_command_t command{};
    command.valid_until_utime = t + 10 * kTickUs;
    for (double& rate : command.drive_rate_radps) rate = sweeps ? 0.0 : 1.6;
    send(channel::kWheelCommand, command, t);
    send_done(t);
  }
  template <class Message>
  void send(const char* channel, Message& message, Utime t) {
    message.header = streams_.next(channel, t, t + kTickUs);
    bus_.publish(channel, &message);
  }
  void send_done(Utime t) {
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
  StreamCounter streams_{"driver", 1};
  StreamCounter reports_{"driver", 1};
  std::map<Utime, Eigen::Isometry3d> poses_;
  double travelled_m_ = 0.0;
  Utime first_ = kNever;
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

struct Recording {
  SimulationSummary summary;
  std::map<Utime, Eigen::Isometry3d> poses;
  std::vector<image_t> left;
  std::vector<cloud_t> clouds;
  std::vector<std::string> heartbeat_texts;
};

WorldConfig rocky_world_config() {
  WorldConfig config;
  config.rocks.k = 0.1;
  return config;
}

std::unique_ptr<World> make_world() {
  return std::make_unique<World>(rocky_world_config(), plane_raster(60.0, 60.0, 1.0, to_rad(5.0), 0.0), 1);
}

Recording drive() {
  SimulatedRoverConfig config;
  config.navcam = load_stereo_rig(kConfig, "navcam");
  config.loccam.scene.far_radius_m = 40.0;
  SimulatedRover rover(config, load_vehicle(kConfig), load_stereo_rig(kConfig, "loccam"), make_world(),
                       {30.0, 30.0, 0.3}, 1);
  SimulatorOptions options;
  options.participants = {"driver", "pan_tilt", "point_cloud"};
  options.end.timeout_s = kSweepS + kDriveS;
  Recording recording;
  lcm::LCM bus("memq://");
  collect(bus, channel::kNavCamLeft, recording.left);
  collect(bus, channel::kCloud, recording.clouds);
  std::vector<heartbeat_t> heartbeats;
  collect(bus, channel::kHeartbeat, heartbeats);
  Simulator simulator(options, rover, bus);
  Node pan_tilt({.name = "pan_tilt"}, bus), point_cloud({.name = "point_cloud"}, bus);
  const auto gaze_service = gaze::make_pan_tilt(pan_tilt, kConfig);
  const auto cloud_service = cloud::make_point_cloud(point_cloud, kConfig);
  const Driver driver(bus);
  pan_tilt.announce();
  point_cloud.announce();
  recording.summary = simulator.run([&] { return pan_tilt.handle(0) && point_cloud.handle(0); });
  recording.poses = driver.poses();
  for (const heartbeat_t& heartbeat : heartbeats) recording.heartbeat_texts.push_back(heartbeat.text);
  return recording;
}

double quantile(std::vector<double>& values, double share) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

class Chain : public testing::Test {
 protected:
  static const Recording& recording() {
    static const Recording kRecording = drive();
    return kRecording;
  }
  static std::vector<Eigen::Vector3d> in_map(const cloud_t& cloud) {
    const Eigen::Isometry3d T_map_cam =
        recording().poses.at(cloud.header.utime) * pose_from(cloud.position_body_cam_m, cloud.quat_body_cam_wxyz);
    std::vector<Eigen::Vector3d> points;
    for (size_t i = 0; i < cloud.x_m.size(); ++i)
      points.push_back(T_map_cam * Eigen::Vector3d(cloud.x_m[i], cloud.y_m[i], cloud.z_m[i]));
    return points;
  }
};

TEST_F(Chain, EachImageOfSweepAndDriveBecomesACloud) {
  EXPECT_TRUE(recording().summary.deterministic);
  EXPECT_GE(recording().left.size(), 12u);
  ASSERT_GE(recording().clouds.size() + 1, recording().left.size());  // the last one may still be in processing
  for (size_t i = 0; i < recording().clouds.size(); ++i) {
    EXPECT_EQ(recording().clouds[i].header.utime, recording().left[i].header.utime);
    EXPECT_GT(recording().clouds[i].point_count, 500) << i;
  }
  for (const std::string& text : recording().heartbeat_texts) EXPECT_EQ(text, "");
}

TEST_F(Chain, PointsMatchTheTrueGround) {
  const auto world = make_world();
  for (const cloud_t& cloud : recording().clouds) {
    const std::vector<Eigen::Vector3d> points = in_map(cloud);
    std::vector<double> near, far;  // quantiles: some points at rock edges are off the ground
    for (size_t i = 0; i < points.size(); ++i)
      (cloud.z_m[i] < 6.0F ? near : far)
          .push_back(std::abs(points[i].z() - world->height_m(points[i].x(), points[i].y())));
    EXPECT_LT(quantile(near, 0.5), 0.01) << cloud.header.utime;
    EXPECT_LT(quantile(near, 0.9), 0.05) << cloud.header.utime;
    if (far.empty()) continue;
    EXPECT_LT(quantile(far, 0.5), 0.04) << cloud.header.utime;
  }
}

TEST_F(Chain, SweepCoversTheGroundFromTheWheels) {
  const Eigen::Isometry3d T_body_map = recording().poses.begin()->second.inverse();
  std::map<std::pair<int, int>, int> seen;  // by azimuth [10 deg] and distance [0.5 m]
  for (const cloud_t& cloud : recording().clouds) {
    if (cloud.header.utime > recording().poses.begin()->first + to_utime(kSweepS)) break;
    for (const Eigen::Vector3d& p_map : in_map(cloud)) {
      const Eigen::Vector3d p = T_body_map * p_map;
      ++seen[{static_cast<int>(std::floor(to_deg(std::atan2(p.y(), p.x())) / 10.0)),
              static_cast<int>(2.0 * std::hypot(p.x(), p.y()))}];
    }
  }
  int hidden = 0;  // behind rocks
  for (int azimuth = -6; azimuth < 6; ++azimuth)
    for (int distance = 3; distance < 10; ++distance) hidden += seen[{azimuth, distance}] <= 5;
  EXPECT_LE(hidden, 4) << "of 84";
}

}  // namespace
}  // namespace rover
