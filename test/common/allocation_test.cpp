// What the 50 Hz loop allocates in its steady state. Its cores: nothing, or blocks of their histories. A node around
// them: a fixed number for each message, because LCM's decoders make strings and arrays.
#include <gtest/gtest.h>

#include <functional>
#include <rover/pose_t.hpp>

#include "supervisor/config.hpp"
#include "supervisor/supervisor.hpp"
#include "test/common/allocations.hpp"
#include "test/localization/synthetic_drive.hpp"
#include "test/trajectory_control/bus_world.hpp"
#include "test/trajectory_control/drive_loop.hpp"
#include "trajectory_control/node.hpp"

namespace rover::test {
namespace {

constexpr int kTicks = 1000;

std::size_t allocations(const std::function<void()>& work) {
  const std::size_t before = allocation_count;
  work();
  return allocation_count - before;
}

TEST(Allocations, PathFollowingAndLocomotionMakeNone) {
  DriveLoop loop;
  loop.controller.set_path({1, 0.75, polyline(seed_traverse())});
  loop.run(20.0);
  EXPECT_EQ(allocations([&] { loop.run(100.0); }), 0u);
  EXPECT_GT(loop.output.arc_length_m, 10.0);
}

TEST(Allocations, LocalizationMakesBlocksOfItsHistories) {
  loc::SyntheticDrive drive(loc::LocalizationConfig{}, 1);
  drive.command = [](double t) { return loc::Twist{t > 2.0 ? 0.2 : 0.0, 0.0}; };
  drive.align_and_start();
  const auto run = [&] { drive.run(to_seconds(kTicks * kTickUs)); };
  run();
  const std::size_t first = allocations(run);
  EXPECT_LE(first, 3u * kTicks);
  EXPECT_LE(allocations(run), first + kTicks / 100);
}

TEST(Allocations, SupervisorMakesBlocksOfItsHistories) {
  const supervisor::SupervisorConfig config = supervisor::load_config(config_dir());
  supervisor::Supervisor supervisor(config);
  Utime now = 0;
  const auto tick = [&] {
    now += kTickUs;
    supervisor::PoseReport pose;
    pose.utime = pose.vo_utime = now;
    pose.usable = true;
    supervisor.on_pose(pose);
    supervisor.on_wheels({.utime = now});
    supervisor.on_imu({now, false});
    supervisor.on_motion_command(now);
    supervisor.on_hazards({now, false, 0.9});
    if (now % (10 * kTickUs) == 0)
      for (const std::string& service : config.fdir.required_services)
        supervisor.on_service(service, {.utime = now, .boot_id = 1});
    supervisor.on_control({.utime = now});
    supervisor.on_planner({.utime = now});
    supervisor.step(now);
  };
  const auto run = [&] {
    for (int i = 0; i < kTicks; ++i) tick();
  };
  run();
  EXPECT_LE(allocations(run), 0.1 * kTicks);
}

TEST(Allocations, OfANodeDoNotGrow) {
  BusWorld world;
  Node node({.name = "trajectory_control"}, world.bus);
  control::TrajectoryControlNode control(node, control::load_config(config_dir()));
  const auto run = [&] {
    for (int i = 0; i < kTicks; ++i) {
      pose_t pose{};
      pose.status = pose_t::OK;
      pose.quat_odom_body_wxyz[0] = 1.0;
      world.send(channel::kPose, pose);
      world.tick(node);
    }
  };
  run();
  const std::size_t first = allocations(run);
  EXPECT_LE(first, 40u * kTicks);  // two messages in, three out, and those of this test
  EXPECT_LE(allocations(run), first + kTicks / 100);
}

}  // namespace
}  // namespace rover::test
