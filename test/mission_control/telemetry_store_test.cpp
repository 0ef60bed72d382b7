// The telemetry store: bus messages to page view.
#include "mission_control/telemetry_store.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <opencv2/imgcodecs.hpp>

#include "common/bus/convert.hpp"
#include "mission_control/image_cache.hpp"

namespace rover::mission {
namespace {

tick_t tick_at(Utime utime) {
  tick_t tick{};
  tick.header.utime = utime;
  return tick;
}

heartbeat_t heartbeat_at(Utime utime, double cpu_s, int pid = getpid(), std::int64_t boot_id = 1) {
  heartbeat_t out{};
  out.header.utime = utime;
  out.header.boot_id = boot_id;
  out.service = "stereo";
  out.pid = pid;
  out.cpu_s = cpu_s;
  return out;
}

image_t image_at(Utime utime, std::uint8_t grey) {
  image_t image{};
  image.header.utime = utime;
  image.width = 16;
  image.height = 8;
  image.data.assign(128, grey);
  image.size = 128;
  return image;
}

hazards_t hazards_at(Utime utime) {
  hazards_t out{};
  out.header.utime = utime;
  out.cell_m = 0.1;
  out.cells_x = 4;
  out.cells_y = 3;
  out.cells.assign(12, hazards_t::FREE);
  out.cells[0] = hazards_t::OBSTACLE;
  out.size = 12;
  return out;
}

Health health(TelemetryStore& store, double wall_s) {
  return store.view(wall_s).services.at("stereo").health;
}

TEST(TelemetryStore, ServiceHealthFollowsHeartbeats) {
  TelemetryStore store({"stereo"});
  EXPECT_EQ(health(store, 0.0), Health::kWaiting);
  store.add(tick_at(1'000'000), 0.0);
  store.add(heartbeat_at(1'000'000, 1.0), 0.0);
  EXPECT_EQ(health(store, 0.1), Health::kOk);
  store.add(tick_at(2'500'000), 0.5);
  EXPECT_EQ(health(store, 0.5), Health::kLost) << "silent";
  store.add(heartbeat_at(2'500'000, 1.0, getpid(), 2), 0.6);
  EXPECT_EQ(health(store, 0.6), Health::kOk);
  EXPECT_EQ(store.view(0.6).services.at("stereo").restarts, 1);
  store.add(heartbeat_at(2'500'000, 1.0, 0, 2), 0.7);
  EXPECT_EQ(health(store, 0.7), Health::kLost) << "no such process";
}

TEST(TelemetryStore, ServiceWithoutHeartbeatIsLostAfterStartup) {
  TelemetryStore store({"stereo"});
  store.add(tick_at(1'000'000), 0.0);
  EXPECT_EQ(health(store, 0.0), Health::kWaiting);
  store.add(tick_at(4'000'000), 1.0);
  EXPECT_EQ(health(store, 1.0), Health::kLost);
}

TEST(TelemetryStore, ServiceThatTheLevelDoesNotNeedIsStopped) {
  TelemetryStore store({"slam", "stereo"});
  supervisor_state_t state{};
  state.full_stopped = 1;
  store.add(state);
  store.add(tick_at(5'000'000), 1.0);
  EXPECT_EQ(store.view(1.0).services.at("slam").health, Health::kStopped);
  state.full_stopped = 0;
  store.add(state);
  EXPECT_EQ(store.view(1.0).services.at("slam").health, Health::kWaiting);
  store.add(tick_at(10'000'000), 3.0);
  EXPECT_EQ(health(store, 3.0), Health::kLost);
  EXPECT_EQ(store.view(3.0).services.at("slam").health, Health::kLost);
  heartbeat_t heartbeat = heartbeat_at(10'000'000, 1.0, getpid(), 2);
  heartbeat.service = "slam";
  store.add(heartbeat, 3.0);
  EXPECT_EQ(store.view(3.0).services.at("slam").restarts, 0) << "started on demand";
}

TEST(TelemetryStore, CpuLoadIsRelativeToWallTime) {
  TelemetryStore store({"stereo"});
  for (int i = 0; i <= 10; ++i) store.add(heartbeat_at(i * 200'000, 0.05 * i), 0.1 * i);
  EXPECT_NEAR(store.view(1.0).services.at("stereo").cpu_percent, 50.0, 1e-6);
}

TEST(TelemetryStore, ShownImageMatchesNewestHazards) {
  TelemetryStore store({});
  for (const Utime utime : {400'000, 800'000, 1'200'000}) store.add_loccam(image_at(utime, 10));
  store.add(hazards_at(800'000));
  const View view = store.view(0.0);
  EXPECT_EQ(view.images.at("loccam").seq, 800'000);
  EXPECT_EQ(view.grids.at("hazards").seq, 800'000);
}

TEST(TelemetryStore, ShowsNewestImageWhenHazardsTimeOut) {
  TelemetryStore store({});
  for (const Utime utime : {400'000, 5'000'000, 5'400'000}) store.add_loccam(image_at(utime, 10));
  EXPECT_EQ(store.view(0.0).images.at("loccam").seq, 5'400'000);
}

TEST(TelemetryStore, HazardGridUsesPoseAtImageTime) {
  TelemetryStore store({});
  for (int i = 0; i < 10; ++i) {
    pose_t pose{};
    pose.header.utime = i * 100'000;
    pose_to(from_planar({0.5 * i, 0.0, 0.0}), pose.position_odom_body_m, pose.quat_odom_body_wxyz);
    pose_to(from_planar({10.0, 20.0, 0.0}), pose.position_map_odom_m, pose.quat_map_odom_wxyz);
    store.add(pose);
  }
  store.add(hazards_at(400'000));
  const View view = store.view(0.0);
  EXPECT_NEAR(view.grids.at("hazards").odom.x_m, 2.0, 1e-9);
  EXPECT_NEAR(view.pose.position_map_m.x(), 14.5, 1e-9);
}

TEST(TelemetryStore, ImagesAreCachedUntilContentChanges) {
  TelemetryStore store({});
  EXPECT_FALSE(store.grid("hazards"));
  EXPECT_EQ(store.image("loccam"), nullptr);
  ImageCache pictures;
  const auto png = [&] { return pictures.grid("hazards", *store.grid("hazards")); };
  store.add(hazards_at(1));
  const auto first = png();
  ASSERT_TRUE(first);
  EXPECT_EQ(png(), first);
  store.add(hazards_at(2));
  EXPECT_NE(png(), first);
  const cv::Mat picture = cv::imdecode(*first, cv::IMREAD_UNCHANGED);
  ASSERT_EQ(picture.size(), cv::Size(4, 3));
  EXPECT_GT(picture.at<cv::Vec4b>(2, 0)[2], 200) << "the first cell is the lower left one, red";
  EXPECT_LT(picture.at<cv::Vec4b>(0, 0)[2], 200);
}

TEST(TelemetryStore, FullLevelGridsAreStored) {
  TelemetryStore store({});
  elevation_t elevation{};
  elevation.cell_m = 0.1;
  elevation.cells_x = elevation.cells_y = 10;
  elevation.size = 100;
  elevation.height_m.assign(100, 1.0F);
  elevation.height_m[5] = std::numeric_limits<float>::quiet_NaN();
  elevation.sigma_m.assign(100, 0.1F);
  store.add(elevation);
  traversability_t terrain{};
  terrain.cell_m = 0.1;
  terrain.cells_x = terrain.cells_y = 10;
  terrain.size = 100;
  terrain.cells.assign(100, 254);
  terrain.step_percent.assign(100, 0);
  terrain.height_m.assign(100, 0.0F);
  store.add(terrain);
  store.add_navcam(image_at(7, 200));
  ImageCache pictures;
  const cv::Mat heights = cv::imdecode(*pictures.grid("elevation", *store.grid("elevation")), cv::IMREAD_UNCHANGED);
  EXPECT_EQ(heights.at<cv::Vec4b>(9, 5)[3], 0) << "never seen";
  EXPECT_GT(heights.at<cv::Vec4b>(9, 6)[3], 0);
  EXPECT_FALSE(
      cv::imdecode(*pictures.grid("traversability", *store.grid("traversability")), cv::IMREAD_UNCHANGED).empty());
  EXPECT_FALSE(cv::imdecode(*pictures.camera("navcam", *store.image("navcam")), cv::IMREAD_UNCHANGED).empty());
}

TEST(TelemetryStore, FullLevelServicesAreStored) {
  TelemetryStore store({});
  EXPECT_EQ(store.view(0.0).slam.utime, kNever);
  ptu_state_t unit{};
  unit.header.utime = 1;
  unit.pan_rad = 0.4;
  unit.moving = 1;
  store.add(unit);
  slam_pose_t slam{};
  slam.header.utime = 2;
  slam.status = slam_pose_t::NO_INFORMATION;
  slam.particles = 80;
  store.add(slam);
  traversability_t terrain{};
  terrain.header.utime = 3;
  terrain.cell_m = 0.1;
  terrain.cells_x = terrain.cells_y = 10;
  terrain.cells.assign(100, traversability_t::UNKNOWN);
  terrain.step_percent.assign(100, 0);
  terrain.height_m.assign(100, 0.0F);
  std::fill_n(terrain.cells.begin(), 25, 0);
  terrain.size = 100;
  terrain.difficulty = 0.3;
  store.add(terrain);
  const View view = store.view(0.0);
  EXPECT_EQ(view.pan_tilt.pan_rad, 0.4);
  EXPECT_TRUE(view.pan_tilt.moving);
  EXPECT_EQ(view.slam.status, 1);
  EXPECT_EQ(view.slam.particles, 80);
  EXPECT_EQ(view.terrain.difficulty, 0.3);
  EXPECT_DOUBLE_EQ(view.terrain.known_fraction, 0.25);
}

TEST(TelemetryStore, CorrectionReportsShiftOfRoverNotOfOdomOrigin) {
  TelemetryStore store({});
  pose_t pose{};
  pose_to(from_planar({30.0, 40.0, 1.0}), pose.position_odom_body_m, pose.quat_odom_body_wxyz);
  pose_to(from_planar({0.0, 0.0, 0.0}), pose.position_map_odom_m, pose.quat_map_odom_wxyz);
  store.add(pose);
  correction_t correction{};
  correction.header.utime = 5;
  correction.accepted = 1;
  correction.yaw_rad = 0.01;  // turns the rover, 50 m away, about the origin
  store.add(correction);
  EXPECT_TRUE(store.view(0.0).correction.accepted);
  EXPECT_NEAR(store.view(0.0).correction.moved_m, 0.5, 1e-3);
  correction.accepted = 0;
  correction.reason = "flat";
  store.add(correction);
  EXPECT_TRUE(std::isnan(store.view(0.0).correction.moved_m));
  EXPECT_EQ(store.view(0.0).correction.reason, "flat");
}

TEST(TelemetryStore, InconsistentMessagesAreIgnored) {
  TelemetryStore store({});
  hazards_t hazards = hazards_at(1);
  hazards.cells_x = 5;
  store.add(hazards);
  hazards = hazards_at(1);
  hazards.cells_x = -4;
  hazards.cells_y = -3;
  store.add(hazards);
  image_t image = image_at(1, 0);
  image.width = 99;
  store.add_navcam(image);
  const View view = store.view(0.0);
  EXPECT_TRUE(view.grids.empty());
  EXPECT_TRUE(view.images.empty());
}

TEST(TelemetryStore, CurrentsArePeaksSinceLastView) {
  TelemetryStore store({});
  wheel_state_t wheels{};
  for (const double current : {1.0, -7.0, 2.0}) {
    wheels.drive_current_a[3] = current;
    store.add(wheels);
  }
  EXPECT_EQ(store.view(0.0).motion.drive_current_a[3], 7.0);
  EXPECT_TRUE(std::isnan(store.view(0.0).motion.drive_current_a[3]));
}

TEST(TelemetryStore, ResetClearsTelemetry) {
  TelemetryStore store({"stereo"});
  store.add(tick_at(9'000'000), 0.0);
  store.add(hazards_at(9'000'000));
  store.reset();
  const View view = store.view(1.0);
  EXPECT_EQ(view.now, kNever);
  EXPECT_TRUE(view.grids.empty());
  EXPECT_EQ(view.services.at("stereo").health, Health::kWaiting);
}

}  // namespace
}  // namespace rover::mission
