#include "@NAME@/node.hpp"

#include <gtest/gtest.h>

#include <rover/@NAME@_t.hpp>

#include "common/core/frames.hpp"
#include "test/stereo/one_node_world.hpp"

namespace rover::@NAME@ {
namespace {

const std::string kConfig = std::string(ROVER_SOURCE_DIR) + "/config";

class @CLASS@NodeTest : public testing::Test {
 protected:
  @CLASS@NodeTest() : world_("@NAME@"), service_(make_@NAME@(world_.node(), kConfig)) {
    world_.record(channel::k@CLASS@, outputs_);
    world_.record(channel::kHeartbeat, heartbeats_);
  }

  void send(double x_m) {
    pose_t pose{};
    pose.position_odom_body_m[0] = x_m;
    pose.quat_odom_body_wxyz[0] = 1.0;
    world_.send(channel::kPose, pose, now_);
  }
  void tick_for(double seconds) {
    for (const Utime until = now_ + to_utime(seconds); now_ < until; now_ += kTickUs) world_.tick(now_);
  }

  Utime now_ = 1'000'000;
  test::OneNodeWorld world_;
  std::shared_ptr<@CLASS@Node> service_;
  std::vector<@NAME@_t> outputs_;
  std::vector<heartbeat_t> heartbeats_;
};

TEST_F(@CLASS@NodeTest, EachPoseGivesTheDistanceAtItsTime) {
  send(0.0);
  tick_for(0.02);
  send(2.0);
  tick_for(0.02);
  ASSERT_EQ(outputs_.size(), 2u);
  EXPECT_EQ(outputs_[0].distance_m, 0.0);
  EXPECT_EQ(outputs_[1].distance_m, 2.0);
  EXPECT_EQ(outputs_[1].header.utime, 1'020'000);
}

TEST_F(@CLASS@NodeTest, NanIsRejectedAndCounted) {
  send(kNaN);
  tick_for(0.5);
  EXPECT_TRUE(outputs_.empty());
  EXPECT_EQ(world_.malformed(channel::kPose), 1);
}

TEST_F(@CLASS@NodeTest, StalePoseDegradesTheHeartbeatUntilTheNextOne) {
  send(0.0);
  tick_for(0.4);
  EXPECT_EQ(heartbeats_.back().status, +heartbeat_t::OK);
  tick_for(1.0);
  EXPECT_EQ(heartbeats_.back().status, +heartbeat_t::DEGRADED);
  send(0.0);
  tick_for(0.4);
  EXPECT_EQ(heartbeats_.back().status, +heartbeat_t::OK);
}

TEST(@CLASS@ConfigTest, ShippedFileHoldsTheDefaults) {
  const NodeConfig file = load_config(kConfig), defaults;
  EXPECT_EQ(file.core.min_step_m, defaults.core.min_step_m);
  EXPECT_EQ(file.max_pose_age_s, defaults.max_pose_age_s);
}

}  // namespace
}  // namespace rover::@NAME@
