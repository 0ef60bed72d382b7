// Each soil at each slope of the project's slope-slip table.
#include <gtest/gtest.h>

#include <optional>

#include "vehicle_fixture.hpp"

namespace rover {
namespace {

struct Case {
  Soil soil;
  double slope_deg;
  std::optional<double> slip;  // absent: stuck
};

constexpr Soil S = Soil::kSand, F = Soil::kFirm, B = Soil::kBedrock;
const Case kTable[] = {{S, 0, 0.05},    {S, 5, 0.10},  {S, 10, 0.22},   {S, 12.5, 0.33}, {S, 15, 0.50}, {S, 17.5, 0.70},
                       {S, 20, 0.95},   {S, 25, {}},   {S, 30, {}},     {F, 0, 0.01},    {F, 5, 0.03},  {F, 10, 0.06},
                       {F, 12.5, 0.09}, {F, 15, 0.14}, {F, 17.5, 0.20}, {F, 20, 0.28},   {F, 25, 0.50}, {F, 30, 0.80},
                       {B, 0, 0.0},     {B, 5, 0.01},  {B, 10, 0.02},   {B, 12.5, 0.03}, {B, 15, 0.04}, {B, 17.5, 0.05},
                       {B, 20, 0.07},   {B, 25, 0.11}, {B, 30, 0.20}};

class SlopeSlip : public testing::TestWithParam<Case> {};

TEST_P(SlopeSlip, MatchesSlopeSlipTableUphill) {
  const Case& c = GetParam();
  const PlaneSurface plane(c.soil, to_rad(c.slope_deg));
  VehicleSim sim(test_vehicle(), {}, plane, {0, 0, 0});
  drive(sim, straight(0.15), 2.0);
  const VehicleTruth before = sim.truth();
  drive(sim, straight(0.15), 2.0);
  const VehicleTruth after = sim.truth();
  const Eigen::Vector3d way = after.T_map_body.translation() - before.T_map_body.translation();
  const double driven = way.norm() * (way.x() > 0.0 ? 1.0 : -1.0);
  const double rolled = 0.125 * (after.wheel_angle_rad[2] - before.wheel_angle_rad[2]);
  const double slip = 1.0 - driven / rolled;
  if (c.slip) {
    EXPECT_NEAR(slip, *c.slip, 0.05);
  } else {
    EXPECT_GT(slip, 0.98);  // no headway, or backwards
  }
  if (std::abs(slip) < 0.9) {
    for (double wheel_slip : after.wheel_slip) EXPECT_NEAR(wheel_slip, slip, 0.03);
  }
  for (Soil soil : after.wheel_soil) EXPECT_EQ(soil, c.soil);
}

INSTANTIATE_TEST_SUITE_P(Table, SlopeSlip, testing::ValuesIn(kTable));

// Downhill the same forces act the other way: the wheels brake, and slip is negative and small on firm ground.
TEST(SlopeSlipDownhill, BrakesOnFirmGround) {
  const PlaneSurface plane(Soil::kFirm, to_rad(10));
  VehicleSim sim(test_vehicle(), {}, plane, {0, 0, kPi});
  drive(sim, straight(0.15), 5.0);
  EXPECT_NEAR(sim.truth().velocity_map_mps.norm(), 0.15, 0.02);
  EXPECT_LT(sim.truth().wheel_slip[2], 0.0);
  EXPECT_GT(sim.truth().wheel_slip[2], -0.1);
}

TEST(GrossTraction, RisesWithSlip) {
  for (Soil soil : {S, F, B}) {
    double before = -1e-9;
    for (double slip = 0.0; slip < 1.3; slip += 0.01) {
      const double traction = gross_traction(soil, slip);
      EXPECT_GE(traction, before);
      before = traction;
    }
    EXPECT_EQ(gross_traction(soil, 0.0), 0.0);
  }
}

class Standing : public testing::TestWithParam<Soil> {};

// No creep on a slope within the soil's traction, after the bristles are loaded.
TEST_P(Standing, HoldsOnSlopeWithoutCreep) {
  const PlaneSurface plane(GetParam(), to_rad(15));
  for (double yaw : {0.0, kPi / 2}) {
    VehicleSim sim(test_vehicle(), {}, plane, {0, 0, yaw});
    drive(sim, straight(0.1), 1.0);
    drive(sim, WheelCommand{}, 15.0);
    const Eigen::Vector3d before = sim.truth().T_map_body.translation();
    drive(sim, WheelCommand{}, 10.0);
    EXPECT_LT((sim.truth().T_map_body.translation() - before).norm(), 2e-5) << yaw;
  }
}

INSTANTIATE_TEST_SUITE_P(Soils, Standing, testing::Values(S, F, B));

}  // namespace
}  // namespace rover
