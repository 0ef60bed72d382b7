#include "traversability/node.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <rover/traversability_t.hpp>

#include "common/core/frames.hpp"
#include "test/stereo/one_node_world.hpp"
#include "test/traversability/synthetic_terrain.hpp"

namespace rover::trav {
namespace {

const std::string kConfig = std::string(ROVER_SOURCE_DIR) + "/config";

elevation_t message_of(const TerrainGrid& grid) {
  elevation_t message{};
  message.cell_m = grid.shape.cell_m;
  message.origin_x_m = grid.shape.origin_x_m;
  message.origin_y_m = grid.shape.origin_y_m;
  message.cells_x = static_cast<std::int16_t>(grid.shape.cells_x);
  message.cells_y = static_cast<std::int16_t>(grid.shape.cells_y);
  message.size = static_cast<std::int32_t>(grid.shape.size());
  message.height_m = grid.height_m;
  message.sigma_m = grid.sigma_m;
  return message;
}

// Flat ground with a rock of 0.3 m at (3.05, 1.05).
elevation_t map_with_rock() {
  return message_of(testing_support::synthetic_terrain(
      [](double x, double y) { return testing_support::block_m(x - 3.05, y - 1.05, 0.3, 0.25); }));
}

pose_t pose_at(double x_m, double y_m, double yaw_rad) {
  pose_t pose{};
  pose.position_odom_body_m[0] = x_m;
  pose.position_odom_body_m[1] = y_m;
  pose.quat_odom_body_wxyz[0] = std::cos(0.5 * yaw_rad);
  pose.quat_odom_body_wxyz[3] = std::sin(0.5 * yaw_rad);
  pose.quat_map_odom_wxyz[0] = 1.0;
  return pose;
}

class TraversabilityNodeTest : public testing::Test {
 protected:
  TraversabilityNodeTest() : world_("traversability"), service_(make_traversability(world_.node(), kConfig)) {
    world_.record(channel::kTraversability, outputs_);
    world_.tick(now_);
  }

  // `age_s`: age of the map on arrival.
  void send(elevation_t map, double age_s = 0.1) {
    now_ += 1'000'000;
    map.header = slam_.next(channel::kElevation, now_ - to_utime(age_s), now_);
    world_.bus().publish(channel::kElevation, &map);
    world_.tick(now_);
    world_.tick(now_ + 200'000);
  }
  // With a pose 0.1 s before the map.
  void send(const pose_t& pose, const elevation_t& map) {
    world_.send(channel::kPose, pose, now_ + 900'000);
    world_.tick(now_ + 900'000);
    send(map);
  }
  static std::uint8_t cell(const traversability_t& map, double x_m, double y_m) {
    const int ix = static_cast<int>((x_m - map.origin_x_m) / map.cell_m);
    const int iy = static_cast<int>((y_m - map.origin_y_m) / map.cell_m);
    return map.cells.at(static_cast<std::size_t>(iy * map.cells_x + ix));
  }

  Utime now_ = 10'000'000;
  test::OneNodeWorld world_;
  StreamCounter slam_{"slam", 1};
  std::shared_ptr<TraversabilityNode> service_;
  std::vector<traversability_t> outputs_;
};

TEST_F(TraversabilityNodeTest, EachElevationMapGivesCostsOnSameGrid) {
  const elevation_t map = map_with_rock();
  send(map);
  ASSERT_EQ(outputs_.size(), 1u);
  const traversability_t& out = outputs_[0];
  EXPECT_EQ(out.header.utime, 10'900'000);
  EXPECT_EQ(out.header.release_utime, 11'100'000);
  EXPECT_EQ(out.cell_m, map.cell_m);
  EXPECT_EQ(out.origin_x_m, map.origin_x_m);
  EXPECT_EQ(out.origin_y_m, map.origin_y_m);
  EXPECT_EQ(out.cells_x, 200);
  EXPECT_EQ(out.cells_y, 200);
  ASSERT_EQ(out.cells.size(), 40000u);
  EXPECT_EQ(cell(out, 3.05, 1.05), +traversability_t::IMPASSABLE);
  EXPECT_LT(cell(out, 1.05, 3.05), 10);
}

TEST_F(TraversabilityNodeTest, DifficultyNeedsAFreshPose) {
  send(map_with_rock());
  send(pose_at(0.0, 1.0, 0.0), map_with_rock());
  send(pose_at(0.0, 1.0, kPi), map_with_rock());
  send(map_with_rock());
  ASSERT_EQ(outputs_.size(), 4u);
  EXPECT_TRUE(std::isnan(outputs_[0].difficulty)) << "no pose";
  EXPECT_GT(outputs_[1].difficulty, 0.05) << "the rock ahead";
  EXPECT_LT(outputs_[2].difficulty, 0.02) << "the rock behind";
  EXPECT_TRUE(std::isnan(outputs_[3].difficulty)) << "an old pose";
}

TEST_F(TraversabilityNodeTest, InvalidPoseGivesNanDifficulty) {
  pose_t lost = pose_at(0.0, 0.0, 0.0);
  lost.status = pose_t::LOST;
  pose_t broken = pose_at(kNaN, 0.0, 0.0);
  for (const pose_t& pose : {lost, broken}) {
    send(pose, map_with_rock());
    ASSERT_FALSE(outputs_.empty());
    EXPECT_TRUE(std::isnan(outputs_.back().difficulty));
  }
}

TEST_F(TraversabilityNodeTest, InvalidMapsAreCountedAndIgnored) {
  std::vector<elevation_t> bad(8, map_with_rock());
  bad[0].cells_x = 199;
  bad[1].cell_m = 0.0;
  bad[2].cell_m = kNaN;
  bad[3].origin_x_m = kInfinity;
  bad[4].origin_y_m = kNaN;
  bad[5].cells_x = bad[5].cells_y = -200;
  bad[6].cells_x = bad[6].cells_y = 0;
  bad[6].size = 0;
  bad[6].height_m.clear();
  bad[6].sigma_m.clear();
  bad[7].cells_x = 2;
  bad[7].cells_y = 20000;
  for (const elevation_t& map : bad) send(map);
  EXPECT_TRUE(outputs_.empty());
  EXPECT_EQ(world_.malformed(channel::kElevation), 8);
  send(map_with_rock());
  EXPECT_EQ(outputs_.size(), 1u);
}

TEST_F(TraversabilityNodeTest, StaleFutureAndRepeatedMapsAreRejected) {
  send(map_with_rock(), 2.5);
  send(map_with_rock(), -0.3);
  EXPECT_TRUE(outputs_.empty());
  send(map_with_rock(), 0.1);
  send(map_with_rock(), 1.1);  // same utime as the previous one
  EXPECT_EQ(outputs_.size(), 1u);
  world_.tick(now_ + 1'000'000);
  EXPECT_EQ(world_.malformed(channel::kElevation), 3);
}

TEST_F(TraversabilityNodeTest, EmptyMapIsUnknownNotEasy) {
  elevation_t map = map_with_rock();
  std::fill(map.height_m.begin(), map.height_m.end(), static_cast<float>(kNaN));
  send(pose_at(0.0, 0.0, 0.0), map);
  ASSERT_EQ(outputs_.size(), 1u);
  EXPECT_TRUE(std::all_of(outputs_[0].cells.begin(), outputs_[0].cells.end(),
                          [](int cost) { return cost == traversability_t::UNKNOWN; }));
  EXPECT_TRUE(std::isnan(outputs_[0].difficulty));
}

TEST_F(TraversabilityNodeTest, PublishesNothingWithoutMaps) {
  for (int k = 1; k <= 20; ++k) {
    world_.send(channel::kPose, pose_at(0.1 * k, 0.0, 0.0), now_ + k * kTickUs);
    world_.tick(now_ + k * kTickUs);
  }
  EXPECT_TRUE(outputs_.empty());
}

class TraversabilityConfigTest : public testing::Test {
 protected:
  TraversabilityConfigTest() : dir_(std::filesystem::path(testing::TempDir()) / "traversability_config") {
    std::filesystem::remove_all(dir_);
    std::filesystem::create_directories(dir_);
    for (const char* file : {"vehicle.yaml", "traversability.yaml"})
      std::filesystem::copy_file(kConfig + "/" + file, dir_ / file);
  }
  void write(const std::string& text) { std::ofstream(dir_ / "traversability.yaml") << text; }

  std::filesystem::path dir_;
};

TEST_F(TraversabilityConfigTest, ShippedFileEqualsDefaultsAndVehicleSetsLimits) {
  const TraversabilityConfig file = load_config(dir_.string()).core, defaults;
  EXPECT_EQ(file.hazard_height_m, 0.15);
  EXPECT_EQ(file.belly_clearance_m, 0.30);
  EXPECT_NEAR(file.footprint_m2, defaults.footprint_m2, 1e-9);
  EXPECT_EQ(file.cost.max_slope_rad, defaults.cost.max_slope_rad);
  EXPECT_EQ(file.step.max_sigma_m, defaults.step.max_sigma_m);
  EXPECT_EQ(file.step.mean_height_ratio, defaults.step.mean_height_ratio);
  EXPECT_EQ(file.plane.radius_m, defaults.plane.radius_m);
  EXPECT_EQ(file.ahead.clearance_m, defaults.ahead.clearance_m);
}

TEST_F(TraversabilityConfigTest, UnknownKeysAndBadRangesThrow) {
  const std::string sections = "plane: {}\nstep: {}\ncost: {}\n";
  write(sections + "ahead: {}\n");
  EXPECT_NO_THROW(load_config(dir_.string()));
  for (const char* bad : {"ahead: {far: 3.0}\n", "ahead: {far_m: 0.9}\n", "ahead: {clearance_m: -1}\n",
                          "ahead: {no_such_key: 0.3}\n", "ahead: {}\nlatency_s: 9.0\n"}) {
    write(sections + bad);
    EXPECT_THROW(load_config(dir_.string()), ConfigError) << bad;
  }
}

}  // namespace
}  // namespace rover::trav
