#include "localization/node.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <random>
#include <rover/command_ack_t.hpp>
#include <rover/imu_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/service_state_t.hpp>
#include <rover/slam_pose_t.hpp>
#include <rover/slip_t.hpp>
#include <rover/vo_motion_t.hpp>
#include <rover/wheel_state_t.hpp>

#include "common/bus/vehicle_config.hpp"
#include "localization/config.hpp"
#include "test/stereo/one_node_world.hpp"

namespace rover::loc {
namespace {

const std::string kConfig = std::string(ROVER_SOURCE_DIR) + "/config";

LocalizationConfig short_alignment() {
  LocalizationConfig config = load_config(kConfig);
  config.static_alignment.duration_s = 1.0;
  return config;
}

ground_command_t start_pose_at(double x) {
  ground_command_t command{};
  command.command_id = 7;
  command.kind = ground_command_t::SET_START_POSE;
  command.position_map_m[0] = x;
  command.sigma_m = 0.1;
  command.sigma_yaw_rad = 0.01;
  return command;
}

class LocalizationNodeTest : public testing::Test {
 protected:
  LocalizationNodeTest() : world_("localization"), node_(world_.node(), short_alignment(), load_vehicle(kConfig)) {
    world_.record(channel::kPose, poses_);
    world_.record(channel::kSlip, slips_);
    world_.record(channel::kCommandAck, acks_);
  }

  void run(double seconds, double speed_mps = 0.0) {
    for (const Utime until = now_ + to_utime(seconds); now_ < until;) {
      now_ += kTickUs;
      imu_t imu{};
      imu.dt_s = 0.02;
      for (double& angle : imu.delta_angle_rad) angle = 1e-6 * normal_(random_);
      imu.delta_velocity_mps[2] = 3.71 * 0.02 + 1e-5 * normal_(random_);
      if (imu_on_) world_.send(channel::kImu, imu, now_);
      wheel_state_t wheels{};
      angle_ += speed_mps * 0.02 / 0.125;
      for (double& a : wheels.drive_angle_rad) a = angle_;
      world_.send(channel::kWheelState, wheels, now_);
      world_.tick(now_);
    }
  }

  void start_pose(double x = 10.0) { world_.send(channel::kGroundCommand, start_pose_at(x), now_); }

  test::OneNodeWorld world_;
  LocalizationNode node_;
  std::vector<pose_t> poses_;
  std::vector<slip_t> slips_;
  std::vector<command_ack_t> acks_;
  std::mt19937_64 random_{1};
  std::normal_distribution<double> normal_;
  Utime now_ = 0;
  double angle_ = 0.0;
  bool imu_on_ = true;
};

TEST_F(LocalizationNodeTest, PublishesPoseEachTickAndSlipTenTimesASecond) {
  run(2.0);
  EXPECT_EQ(poses_.size(), 100U);
  EXPECT_EQ(slips_.size(), 20U);
  EXPECT_EQ(poses_.back().status, int{pose_t::UNINITIALISED});
  start_pose();
  run(0.5);
  ASSERT_EQ(acks_.size(), 1U);
  EXPECT_EQ(acks_[0].accepted, 1);
  EXPECT_EQ(acks_[0].command_id, 7);
  EXPECT_EQ(poses_.back().status, int{pose_t::OK});
  EXPECT_EQ(poses_.back().header.utime, now_);
  EXPECT_NEAR(poses_.back().position_map_odom_m[0], 10.0, 1e-6);
  EXPECT_GT(poses_.back().covariance[0], 0.0);
}

TEST_F(LocalizationNodeTest, RejectedStartPoseHasReason) {
  start_pose();
  run(0.1);
  ASSERT_EQ(acks_.size(), 1U);
  EXPECT_EQ(acks_[0].accepted, 0);
  EXPECT_FALSE(acks_[0].reason.empty());
  run(2.0);
  start_pose(kNaN);
  run(0.1);
  ASSERT_EQ(acks_.size(), 2U);
  EXPECT_EQ(acks_[1].accepted, 0);
}

TEST_F(LocalizationNodeTest, MissingImuDegradesButPoseContinues) {
  run(2.0);
  start_pose();
  imu_on_ = false;
  const size_t before = poses_.size();
  run(1.0, 0.1);
  EXPECT_EQ(poses_.size(), before + 50);
  EXPECT_EQ(poses_.back().status, int{pose_t::DEGRADED});
  EXPECT_NEAR(poses_.back().position_odom_body_m[0], 0.1, 0.01);
}

// Along the ridges wheels slip unseen.
TEST_F(LocalizationNodeTest, SlamPoseWithoutInformationMovesMapButMeasuresNoDistance) {
  run(2.0);
  start_pose();
  run(1.0, 0.1);
  slam_pose_t slam{};
  slam.x_m = poses_.back().position_map_odom_m[0];
  slam.covariance[0] = slam.covariance[4] = slam.covariance[8] = 1e-4;
  for (int i = 0; i < 5; ++i) {
    world_.send(channel::kSlamPose, slam, now_);
    slam.x_m += 0.02;
    run(5.0, 0.1);
  }
  EXPECT_GT(poses_.back().position_map_odom_m[0], 10.04);
  EXPECT_EQ(poses_.back().status, int{pose_t::LOST});
}

TEST_F(LocalizationNodeTest, InvalidInputIsCounted) {
  run(2.0);
  imu_t imu{};
  imu.dt_s = kNaN;
  world_.send(channel::kImu, imu, now_ + 1);
  vo_motion_t motion{};
  motion.position_m[0] = kNaN;
  world_.send(channel::kVo, motion, now_ + 1);
  run(0.2);
  EXPECT_EQ(world_.malformed(channel::kImu), 1);
  EXPECT_EQ(world_.malformed(channel::kVo), 1);
}

// The service on its own bus, with a run folder.
class Process {
 public:
  Process(const std::string& folder, std::int64_t boot_id, Utime now, double angle)
      : bus_("memq://"),
        world_("world", 1),
        now_(now),
        angle_(angle),
        node_({.name = "localization", .boot_id = boot_id, .run_dir = folder}, bus_) {
    record(channel::kPose, poses);
    record(channel::kServiceState, states);
    service_ = std::make_unique<LocalizationNode>(node_, short_alignment(), load_vehicle(kConfig));
  }

  void run(double seconds, double speed_mps = 0.0) {
    for (const Utime until = now_ + to_utime(seconds); now_ < until;) {
      now_ += kTickUs;
      imu_t imu{};
      imu.dt_s = 0.02;
      imu.delta_velocity_mps[2] = 3.71 * 0.02 + 1e-5 * normal_(random_);
      send(channel::kImu, imu);
      wheel_state_t wheels{};
      angle_ += speed_mps * 0.02 / 0.125;
      for (double& a : wheels.drive_angle_rad) a = angle_;
      send(channel::kWheelState, wheels);
      tick_t tick{};
      tick.header = world_.next(channel::kTick, now_, now_);
      tick.members = {"localization"};
      tick.member_count = 1;
      tick.streams = world_.take_updated();
      tick.stream_count = static_cast<std::int32_t>(tick.streams.size());
      bus_.publish(channel::kTick, &tick);
      while (bus_.handleTimeout(0) > 0) node_.handle(0);
    }
  }

  template <class Message>
  void send(const char* channel, Message message) {
    message.header = world_.next(channel, now_, now_);
    bus_.publish(channel, &message);
  }

  std::vector<pose_t> poses;
  std::vector<service_state_t> states;
  Utime now() const { return now_; }
  double angle() const { return angle_; }

 private:
  template <class Message>
  void record(const char* channel, std::vector<Message>& out) {
    bus_.subscribeFunction(
        channel,
        +[](const lcm::ReceiveBuffer* buffer, const std::string&, std::vector<Message>* messages) {
          Message message;
          if (decode_message(buffer->data, static_cast<int>(buffer->data_size), message)) messages->push_back(message);
        },
        &out);
  }

  lcm::LCM bus_;
  StreamCounter world_;
  Utime now_;
  double angle_;
  Node node_;
  std::unique_ptr<LocalizationNode> service_;
  std::mt19937_64 random_{1};
  std::normal_distribution<double> normal_;
};

TEST(LocalizationCheckpoint, NewProcessContinuesFromCheckpoint) {
  const std::string folder = testing::TempDir() + "/localization_checkpoint";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  Process first(folder, 1, 0, 0.0);
  first.run(2.0);
  first.send(channel::kGroundCommand, start_pose_at(10.0));
  first.run(5.0, 0.2);
  ASSERT_TRUE(first.states.empty());
  // Down for 1 s, during which the rover rolls 0.1 m.
  Process second(folder, 2, first.now() + 1'000'000, first.angle() + 0.1 / 0.125);
  second.run(1.0);
  ASSERT_EQ(second.states.size(), 1U);
  EXPECT_EQ(second.states[0].service, "localization");
  EXPECT_EQ(second.poses.back().status, int{pose_t::DEGRADED}) << "without images";
  EXPECT_EQ(second.poses.back().position_map_odom_m[0], first.poses.back().position_map_odom_m[0]);
  EXPECT_NEAR(second.poses.back().position_odom_body_m[0], first.poses.back().position_odom_body_m[0] + 0.1, 0.01);
}

// Nobody sends it again.
TEST(LocalizationCheckpoint, AStartPoseThatWasAcceptedIsSavedAtOnce) {
  const std::string folder = testing::TempDir() + "/localization_checkpoint_at_once";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  Process first(folder, 1, 0, 0.0);
  first.run(2.5);
  first.send(channel::kGroundCommand, start_pose_at(10.0));
  first.run(0.1);
  ASSERT_NE(first.poses.back().status, int{pose_t::UNINITIALISED});
  Process second(folder, 2, first.now() + 500'000, first.angle());
  second.run(0.1);
  EXPECT_NE(second.poses.back().status, int{pose_t::UNINITIALISED});
  std::filesystem::remove_all(folder);
}

TEST(LocalizationConfigFile, MatchesDefaults) {
  const LocalizationConfig file = load_config(kConfig);
  const LocalizationConfig defaults;
  EXPECT_EQ(file.filter.visual_scale_sigma, defaults.filter.visual_scale_sigma);
  EXPECT_EQ(file.filter.mounting_sigma_rad, defaults.filter.mounting_sigma_rad);
  EXPECT_EQ(file.filter.slip_sigma, defaults.filter.slip_sigma);
  EXPECT_EQ(file.filter.fog_bias_sigma_radps, defaults.filter.fog_bias_sigma_radps);
  EXPECT_EQ(file.static_alignment.duration_s, defaults.static_alignment.duration_s);
  EXPECT_EQ(file.stationary.rate_radps, defaults.stationary.rate_radps);
  EXPECT_EQ(file.slip.window_s, defaults.slip.window_s);
  EXPECT_EQ(file.status.max_dead_reckoned_m, defaults.status.max_dead_reckoned_m);
}

}  // namespace
}  // namespace rover::loc
