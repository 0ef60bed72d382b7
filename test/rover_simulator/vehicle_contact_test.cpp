#include <gtest/gtest.h>

#include "rover_simulator/vehicle/height_cache.hpp"
#include "rover_simulator/vehicle/wheel_contact.hpp"
#include "rover_simulator/world/world.hpp"
#include "vehicle_fixture.hpp"
#include "world_fixture.hpp"

namespace rover {
namespace {

WheelContact contact_at(const Surface& surface, const Eigen::Vector3d& axle) {
  HeightCache heights(surface);
  return find_contact({}, test_vehicle(), heights, axle, Eigen::Matrix3d::Identity());
}

TEST(HeightCache, MatchesSurfaceWithinSamplingError) {
  WorldConfig config;
  const World world(config, level_raster(40), 3);
  HeightCache heights(world);
  double squares = 0.0;
  int count = 0;
  for (double x = 10; x < 16; x += 0.0173)
    for (double y = 10; y < 16; y += 0.0311, ++count)
      squares += std::pow(heights.height_m(x, y) - world.height_m(x, y), 2);
  EXPECT_LT(std::sqrt(squares / count), 0.002);
  EXPECT_NEAR(heights.height_m(10.25, -3.17), world.height_m(10.25, -3.17), 1e-5);  // a sample, south of the origin
}

TEST(HeightCache, DoesNotDependOnQueryOrder) {
  const World world(WorldConfig{}, level_raster(40), 3);
  HeightCache first(world), second(world);
  (void)second.height_m(30.0, 30.0);  // shares a slot with other places
  (void)second.height_m(14.88, 14.88);
  for (double x = 9; x < 20; x += 0.31) EXPECT_EQ(first.height_m(x, x), second.height_m(x, x));
}

TEST(WheelContact, ForceIsVerticalOnLevelGround) {
  const PlaneSurface level(Soil::kFirm, 0.0);
  const WheelContact contact = contact_at(level, {5.0, 5.0, 0.122});
  EXPECT_NEAR(contact.load_n, 62.0, 8.0);  // 3 mm deep
  EXPECT_NEAR(contact.normal.z(), 1.0, 1e-3);
  EXPECT_NEAR(contact.sinkage_m, 0.003, 2e-4);
  EXPECT_EQ(contact.soil_fraction[1], 1.0);
  EXPECT_EQ(contact_at(level, {5.0, 5.0, 0.126}).load_n, 0.0);
}

TEST(WheelContact, ForceIsNormalToSlope) {
  const double slope = to_rad(20);
  const PlaneSurface plane(Soil::kFirm, slope);
  const Eigen::Vector3d normal(-std::sin(slope), 0.0, std::cos(slope));
  const WheelContact contact = contact_at(plane, Eigen::Vector3d(2.0, 0.0, std::tan(slope) * 2.0) + 0.122 * normal);
  EXPECT_GT(contact.normal.dot(normal), std::cos(to_rad(1.0)));
}

// Rolled with the slope.
TEST(WheelContact, WheelAcrossASlopeIsNoHigherThanOnLevelGround) {
  for (const double slope_deg : {5.0, 15.0, 20.0}) {
    const PlaneSurface plane(Soil::kFirm, to_rad(slope_deg));
    const Eigen::Vector3d normal(-std::sin(to_rad(slope_deg)), 0.0, std::cos(to_rad(slope_deg)));
    Eigen::Matrix3d R;
    R << Eigen::Vector3d::UnitY(), normal.cross(Eigen::Vector3d::UnitY()), normal;
    HeightCache heights(plane);
    const auto load_n = [&](double axle_m) {
      const Eigen::Vector3d axle = Eigen::Vector3d(2.0, 0.0, std::tan(to_rad(slope_deg)) * 2.0) + axle_m * normal;
      return find_contact({}, test_vehicle(), heights, axle, R).load_n;
    };
    EXPECT_NEAR(load_n(0.122), 62.0, 8.0) << slope_deg;
    EXPECT_EQ(load_n(0.126), 0.0) << slope_deg;
  }
}

TEST(WheelContact, WallPushesWheelBack) {
  const FeatureSurface wall([](double x, double) { return x > 5.11 ? 0.5 : 0.0; });
  const WheelContact contact = contact_at(wall, {5.0, 5.0, 0.125});
  EXPECT_GT(contact.load_n, 0.0);
  EXPECT_LT(contact.normal.x(), -0.7);
  EXPECT_NEAR(contact.climb_m, 0.5, 1e-9);
}

TEST(WheelContact, RockUnderTheEdgeAloneIsClimbedWithoutLoad) {
  const FeatureSurface flank([](double, double y) { return y > 5.055 ? 0.25 : 0.0; });
  const Eigen::Vector3d axle(5.0, 5.0, 0.122);
  HeightCache heights(flank);
  EXPECT_EQ(contact_at(flank, axle).climb_m, 0.0);
  EXPECT_EQ(climb_at_edges_m({}, test_vehicle(), heights, axle, Eigen::Matrix3d::Identity()), 0.25);
}

// Drives over a full-width bump; returns the maximum climb and whether the rover got across.
struct Crossing {
  double climb_m = 0.0;
  bool across = false;
  Collision collision = Collision::kNone;
  double min_clearance_m = 1.0;
};

Crossing cross(const std::function<double(double, double)>& feature, double seconds) {
  const FeatureSurface surface(feature);
  VehicleSim sim(test_vehicle(), {}, surface, {0, 0, 0});
  Crossing crossing;
  for (int tick = 0; tick < seconds * 50; ++tick) {
    sim.advance(0.02, straight(0.1));
    const VehicleTruth& truth = sim.truth();
    crossing.climb_m = std::max(crossing.climb_m, truth.climb_m);
    crossing.min_clearance_m = std::min(crossing.min_clearance_m, truth.clearance_m);
    if (truth.collision != Collision::kNone) crossing.collision = truth.collision;
    EXPECT_TRUE(is_finite(truth.T_map_body));
    EXPECT_LT(truth.velocity_map_mps.norm(), 1.0);
  }
  crossing.across = sim.truth().T_map_body.translation().x() > 2.5;
  return crossing;
}

// Block of this height with flanks of 63 degrees, under the left wheels.
std::function<double(double, double)> block(double height_m) {
  return [height_m](double x, double y) {
    const double edge = std::min({x - 1.3, 1.8 - x, y - 0.2, 0.7 - y});
    return std::clamp(2.0 * edge, 0.0, height_m);
  };
}

TEST(VehicleClimb, WheelsClimbRocksOfTenCentimetres) {
  const Crossing crossing = cross(block(0.10), 40.0);
  EXPECT_TRUE(crossing.across);
  EXPECT_NEAR(crossing.climb_m, 0.10, 0.005);
  EXPECT_EQ(crossing.collision, Collision::kNone);
}

TEST(VehicleClimb, RockAboveClimbLimitIsCollision) {
  EXPECT_EQ(cross(block(0.28), 30.0).collision, Collision::kWheelClimb);
}

TEST(VehicleClimb, RockUnderBellyIsCollision) {
  const Crossing crossing =
      cross([](double x, double y) { return std::clamp(3.0 * (0.2 - std::hypot(x - 1.5, y)), 0.0, 0.35); }, 20.0);
  EXPECT_EQ(crossing.collision, Collision::kBodyContact);
  EXPECT_LT(crossing.min_clearance_m, 0.0);
  EXPECT_EQ(crossing.climb_m, 0.0);
}

TEST(VehicleClimb, StoneBetweenWheelsReducesClearance) {
  const Crossing crossing =
      cross([](double x, double y) { return std::clamp(3.0 * (0.1 - std::hypot(x - 1.5, y)), 0.0, 0.15); }, 20.0);
  EXPECT_EQ(crossing.collision, Collision::kNone);
  EXPECT_NEAR(crossing.min_clearance_m, 0.147, 0.01);
}

TEST(VehicleClimb, StoneThatMeetsTheRearBogieIsCollision) {
  const Crossing crossing =
      cross([](double x, double y) { return std::clamp(3.0 * (0.15 - std::hypot(x - 1.5, y)), 0.0, 0.28); }, 30.0);
  EXPECT_EQ(crossing.collision, Collision::kBodyContact);
  EXPECT_GT(crossing.min_clearance_m, 0.0);
}

TEST(VehicleClimb, StoneThatMeetsTheForkBesideAWheelIsCollision) {
  const auto stone_at = [](double y_m) {
    return [=](double x, double y) { return std::clamp(9.0 * (0.04 - std::hypot(x - 1.5, y - y_m)), 0.0, 0.22); };
  };
  EXPECT_EQ(cross(stone_at(0.31), 20.0).collision, Collision::kBodyContact);
  EXPECT_EQ(cross(stone_at(0.25), 20.0).collision, Collision::kNone);
}

// The wheel's outer edge is at 0.47 m.
TEST(VehicleClimb, RockUnderTheEdgeOfAWheelIsCollision) {
  const auto flank_from = [](double y_m) {
    return [=](double x, double y) { return x > 1.3 && x < 1.7 && y > y_m ? 0.28 : 0.0; };
  };
  EXPECT_EQ(cross(flank_from(0.462), 20.0).collision, Collision::kWheelClimb);
  EXPECT_EQ(cross(flank_from(0.482), 20.0).collision, Collision::kNone);
}

TEST(VehicleClimb, DrivingIntoWallIsCollision) {
  EXPECT_EQ(cross([](double x, double) { return std::clamp((x - 1.5) * 20.0, 0.0, 1.0); }, 15.0).collision,
            Collision::kWheelClimb);
}

}  // namespace
}  // namespace rover
