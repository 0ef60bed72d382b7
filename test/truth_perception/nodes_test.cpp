#include "tools/truth_perception/nodes.hpp"

#include <gtest/gtest.h>

#include <rover/cloud_t.hpp>
#include <rover/elevation_t.hpp>
#include <rover/hazards_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/traversability_t.hpp>
#include <rover/truth_t.hpp>
#include <set>

#include "common/bus/convert.hpp"
#include "common/bus/vehicle_config.hpp"
#include "path_planner/convert.hpp"
#include "rover_simulator/simulator.hpp"
#include "test/stereo/one_node_world.hpp"
#include "test/truth_perception/scene.hpp"

namespace rover::truth {
namespace {

const std::string kConfig = std::string(ROVER_SOURCE_DIR) + "/config";

truth_t truth_at(double x_m, double y_m) {
  truth_t truth{};
  pose_to(make_pose(Eigen::Matrix3d::Identity(), {x_m, y_m, 0.62}), truth.position_map_body_m,
          truth.quat_map_body_wxyz);
  return truth;
}

class TruthNodesTest : public testing::Test {
 protected:
  TruthNodesTest() { surface_.blocks = {{12.0, 20.0, 0.2, 0.3}}; }

  Blocks surface_;
  TruthPerception perception_{std::make_shared<TrueSurface>(surface_), kConfig};
};

TEST_F(TruthNodesTest, HazardsComeAtEachExposureWithTheLatencyOfStereoAndDetector) {
  test::OneNodeWorld world("hazard_detector");
  const auto service = make_truth_hazards(world.node(), perception_);
  std::vector<hazards_t> hazards;
  world.record(channel::kHazards, hazards);
  for (Utime t = 1'000'000; t < 2'000'000; t += kTickUs) {
    world.send(channel::kTruth, truth_at(10.0, 20.0), t);
    world.tick(t);
  }
  ASSERT_EQ(hazards.size(), 3u);
  EXPECT_EQ(hazards[1].header.utime, 1'400'000);
  EXPECT_EQ(hazards[1].header.release_utime, 1'640'000);  // 0.06 s image, 0.12 s stereo, 0.06 s detection
  EXPECT_EQ(hazards[1].header.publisher, "hazard_detector");
  const planning::HazardGrid grid = planning::hazards_from(hazards[1]);
  EXPECT_EQ(grid.fault(), "");
  EXPECT_EQ(grid.at({2.0, 0.0}), planning::HazardGrid::kObstacle);
  EXPECT_EQ(grid.at({2.0, 0.6}), planning::HazardGrid::kFree);
}

TEST_F(TruthNodesTest, ExposuresAreThoseOfTheSimulator) {
  auto world = std::make_unique<World>(WorldConfig{}, plane_raster(40.0, 40.0, 1.0, 0.0, 0.0), 1);
  const TruthPerception perception{std::make_shared<TrueSurface>(*world), kConfig};
  SimulatedRover rover({}, load_vehicle(kConfig), load_stereo_rig(kConfig, "loccam"), std::move(world),
                       {20.0, 20.0, 0.0}, 1);
  lcm::LCM bus("memq://");
  SimulatorOptions options;
  options.participants = {"hazard_detector"};
  options.end.timeout_s = 2.0;
  std::set<Utime> exposures, hazards;
  Node node({.name = "hazard_detector"}, bus);
  InProcess in_process;
  in_process.loccam = [&](Utime utime, const Eigen::Isometry3d&) { exposures.insert(utime); };
  in_process.run_services = [&] {
    const bool waited = bus.handleTimeout(0) > 0;
    node.handle(0);  // also the TICK that the simulator itself took from the shared bus
    return waited;
  };
  Simulator simulator(options, rover, bus, nullptr, in_process);
  const auto service = make_truth_hazards(node, perception);
  bus.subscribeFunction(
      channel::kHazards,
      +[](const lcm::ReceiveBuffer* buffer, const std::string&, std::set<Utime>* utimes) {
        hazards_t message;
        if (decode_message(buffer->data, static_cast<int>(buffer->data_size), message))
          utimes->insert(message.header.utime);
      },
      &hazards);
  node.announce();
  simulator.run([] { return true; });
  EXPECT_EQ(exposures.size(), 5u);
  EXPECT_EQ(hazards, exposures);
}

class TruthTraversabilityTest : public TruthNodesTest {
 protected:
  TruthTraversabilityTest()
      : world_("traversability"), service_(make_truth_traversability(world_.node(), perception_)) {
    world_.record(channel::kTraversability, maps_);
  }

  // Odom is 3 m east and 1 m south of the world.
  void send_poses(Utime t) {
    world_.send(channel::kTruth, truth_at(10.0, 20.0), t);
    pose_t pose{};
    pose_to(make_pose(Eigen::Matrix3d::Identity(), {7.0, 21.0, 0.62}), pose.position_odom_body_m,
            pose.quat_odom_body_wxyz);
    pose.quat_map_odom_wxyz[0] = 1.0;
    world_.send(channel::kPose, pose, t);
  }
  void send_cloud(Utime exposure, Utime t) {
    cloud_t cloud{};
    pose_to(load_stereo_rig(kConfig, "navcam").T_body_left, cloud.position_body_cam_m, cloud.quat_body_cam_wxyz);
    world_.send(channel::kCloud, cloud, exposure, t);
  }
  void send_elevation(Utime exposure, Utime t) {
    elevation_t elevation{};
    elevation.cell_m = 0.1;
    elevation.origin_x_m = -3.0;
    elevation.origin_y_m = 11.0;
    elevation.cells_x = elevation.cells_y = 200;
    elevation.size = 40'000;
    elevation.height_m.assign(40'000, static_cast<float>(kNaN));
    elevation.sigma_m = elevation.height_m;
    world_.send(channel::kElevation, elevation, exposure, t);
  }
  void run(Utime until) {
    for (; t_ < until; t_ += kTickUs) {
      send_poses(t_);
      if (t_ == 1'260'000) send_cloud(1'000'000, t_);
      if (t_ == 1'360'000) send_elevation(1'000'000, t_);
      world_.tick(t_);
    }
  }

  Utime t_ = 1'000'000;
  test::OneNodeWorld world_;
  std::shared_ptr<void> service_;
  std::vector<traversability_t> maps_;
};

TEST_F(TruthTraversabilityTest, OneMapPerElevationInOdomAcceptedByThePlanner) {
  run(1'600'000);
  ASSERT_EQ(maps_.size(), 1u);
  EXPECT_EQ(maps_[0].header.utime, 1'000'000);
  EXPECT_EQ(maps_[0].header.release_utime, 1'460'000);
  EXPECT_EQ(maps_[0].header.publisher, "traversability");
  const planning::TraversabilityGrid grid = planning::traversability_from(maps_[0]);
  EXPECT_EQ(grid.fault(), "");
  const auto at = [&](double x_m, double y_m) {
    return grid
        .cells[static_cast<size_t>(static_cast<int>((y_m - 11.0) / 0.1) * 200 + static_cast<int>((x_m + 3.0) / 0.1))];
  };
  EXPECT_EQ(at(9.03, 21.03), +traversability_t::IMPASSABLE);
  EXPECT_LT(at(10.03, 21.63), +traversability_t::IMPASSABLE);
  EXPECT_EQ(at(5.03, 21.03), +traversability_t::UNKNOWN);
  EXPECT_GT(maps_[0].difficulty, 0.0);
}

TEST_F(TruthTraversabilityTest, ElevationWithoutItsTruthIsRejected) {
  run(1'200'000);
  send_elevation(500'000, t_);
  world_.tick(t_);
  run(3'000'000);
  EXPECT_EQ(maps_.size(), 1u);
  EXPECT_EQ(world_.malformed(channel::kElevation), 1);
}

}  // namespace
}  // namespace rover::truth
