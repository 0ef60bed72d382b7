#include "hazard_detector/hazard_detector.hpp"

#include <gtest/gtest.h>

#include "test/hazard_detector/scene.hpp"

namespace rover::hazard {
namespace {

using HazardDetectorTest = SceneTest;

TEST_F(HazardDetectorTest, FlatGroundIsFreeWhereBothCamerasSeeIt) {
  const HazardResult result = detect({});
  EXPECT_EQ(result.status, Status::kClear);
  EXPECT_TRUE(std::isnan(result.nearest_hazard_m));
  EXPECT_GT(result.coverage, 0.9);
  EXPECT_EQ(map(result).hazards(), 0);
  EXPECT_NEAR(result.plane.pitch_rad(), 0.0, to_rad(0.3));
  // The common field of view widens from +-0.4 m at the wheels to +-0.7 m at 1.6 m.
  for (double x = 1.05; x < 2.7; x += 0.1)
    for (double y = -0.65; y <= 0.7; y += 0.1)
      if (std::abs(y) < 0.3 + 0.55 * (x - 1.0)) {
        EXPECT_EQ(map(result).at(x, y), Cell::kFree) << x << " " << y;
      }
}

TEST_F(HazardDetectorTest, NoFalseAlarmInThousandsOfNoisyFrames) {
  for (const synthetic::World& world : {synthetic::World{}, under_pitched_body(9.0), sloped(-10.0)}) {
    const auto exact = synthetic::exact_disparity(world, camera_);
    for (int frame = 0; frame < 700; ++frame) {
      const double sigma_px = 0.15 + 0.05 * (frame % 4);
      const HazardResult result = detector_.step(noise_.apply(exact, camera_, sigma_px, 0.08), camera_);
      ASSERT_EQ(result.status, Status::kClear) << frame;
    }
  }
}

TEST_F(HazardDetectorTest, FlatGroundIsClearUnderBodyPitchOfTenDegrees) {
  for (double pitch_deg : {-10.0, -9.0, -8.0, 8.0, 9.0, 10.0}) {
    const HazardResult result = detect(under_pitched_body(pitch_deg));
    EXPECT_EQ(result.status, Status::kClear) << pitch_deg;
    EXPECT_NEAR(result.plane.pitch_rad(), to_rad(pitch_deg), to_rad(0.3));
  }
}

TEST_F(HazardDetectorTest, SlopesOfTenDegreesInAllDirectionsAreClear) {
  for (double heading_deg = 0.0; heading_deg < 360.0; heading_deg += 30.0) {
    const double heading = to_rad(heading_deg);
    const HazardResult result = detect(sloped(10.0 * std::cos(heading), 10.0 * std::sin(heading)));
    EXPECT_EQ(result.status, Status::kClear) << heading_deg;
    EXPECT_NEAR(result.plane.roll_rad(), to_rad(10.0 * std::sin(heading)), to_rad(0.5));
  }
}

TEST_F(HazardDetectorTest, RollingGroundIsClear) {
  for (double phase = 0.0; phase < 6.2; phase += 0.9) {
    synthetic::World world;
    world.relief = [phase](double x, double y) { return 0.1 * std::sin(2.1 * x + phase) * std::cos(1.2 * y + phase); };
    const HazardResult result = detect(world);
    EXPECT_EQ(result.status, Status::kClear) << phase;
    EXPECT_GT(map(result).count_near(Cell::kFree, 1.8, 0.0, 0.5), 60) << phase;
  }
}

TEST_F(HazardDetectorTest, FlatTopRockOfSeventeenCentimetresIsLowAndOneOfThirtyIsNot) {
  synthetic::World world;
  world.rocks.push_back({1.8, 0.1, 0.15, 0.17, true});
  const HazardResult result = detect(world);
  EXPECT_EQ(result.status, Status::kHazard);
  EXPECT_EQ(map(result).at(1.8, 0.05), Cell::kLow);
  EXPECT_NEAR(result.nearest_hazard_m, 1.65, 0.12);
  EXPECT_GT(map(result).count_near(Cell::kMargin, 1.8, 0.1, 0.35), 8);
  EXPECT_EQ(map(result).count_near(Cell::kFree, 1.8, 0.1, 0.15), 0);
  world.rocks.front().height_m = 0.30;
  EXPECT_EQ(map(detect(world)).at(1.8, 0.05), Cell::kObstacle);
}

// Stereo measures the lower 17 cm of a rock of 30 cm.
TEST_F(HazardDetectorTest, ARockWhoseTopIsNotMeasuredIsNotLow) {
  for (const double x : {1.3, 1.8, 2.3, 2.8}) {
    synthetic::World world;
    world.rocks = {{x, 0.1, 0.15, 0.17, true}, {x, 0.1, 0.149, 0.30, true, true}};
    const HazardResult result = detect(world);
    EXPECT_EQ(map(result).count(Cell::kLow), 0) << x;
    EXPECT_GT(map(result).count_near(Cell::kObstacle, x - 0.1, 0.1, 0.2), 3) << x;
  }
}

TEST_F(HazardDetectorTest, RocksOfTenCentimetresAreFree) {
  for (double x = 1.25; x < 2.8; x += 0.2)
    for (bool box : {false, true}) {
      synthetic::World world;
      world.rocks.push_back({x, 0.05, 0.1, 0.10, box});
      const HazardResult result = detect(world);
      EXPECT_EQ(result.status, Status::kClear) << x;
      EXPECT_EQ(map(result).at(x, 0.05), Cell::kFree) << x << " " << box;
    }
}

TEST_F(HazardDetectorTest, TexturelessRockIsNeverFree) {
  for (double x : {1.3, 1.8, 2.3}) {
    synthetic::World world;
    world.rocks.push_back({x, 0.0, 0.25, 0.25, false, true});
    const HazardResult result = detect(world);
    EXPECT_EQ(map(result).count_near(Cell::kFree, x, 0.0, 0.2), 0) << x;
  }
}

TEST_F(HazardDetectorTest, GroundHiddenBehindARockIsUnseen) {
  synthetic::World world;
  world.rocks.push_back({1.5, 0.0, 0.2, 0.3, true});
  const HazardResult result = detect(world);
  // The line of sight over the top of the rock meets the ground 0.9 m behind it.
  for (double x = 1.95; x < 2.4; x += 0.1) EXPECT_EQ(map(result).at(x, 0.0), Cell::kUnseen) << x;
}

TEST_F(HazardDetectorTest, FrameWithoutStereoIsBlind) {
  const HazardResult result = detector_.step(Disparity(512, 384), camera_);
  EXPECT_EQ(result.status, Status::kBlind);
  EXPECT_EQ(result.coverage, 0.0);
  EXPECT_EQ(map(result).count(Cell::kUnseen), detector_.shape().size());
  EXPECT_FALSE(result.plane.measured);
}

TEST_F(HazardDetectorTest, ImageHalfWithoutStereoIsUnseenThereAndFreeElsewhere) {
  auto exact = synthetic::exact_disparity({}, camera_);
  for (int v = 0; v < 384; ++v)
    for (int u = 0; u < 220; ++u) exact[static_cast<size_t>(v) * 512 + u] = 0.0f;
  const HazardResult result = detector_.step(noise_.apply(exact, camera_, 0.2, 0.0), camera_);
  EXPECT_EQ(result.status, Status::kClear);
  EXPECT_EQ(map(result).at(1.85, 0.45), Cell::kUnseen);
  EXPECT_EQ(map(result).at(1.85, -0.25), Cell::kFree);
  EXPECT_LT(result.coverage, 0.7);
}

// A patch of smooth dust. Whether the rover may continue over unseen ground is decided by the planner.
TEST_F(HazardDetectorTest, NoStereoNearTheWheelsLeavesThatGroundUnseen) {
  auto exact = synthetic::exact_disparity({}, camera_);
  std::fill(exact.begin() + 150 * 512, exact.end(), 0.0f);
  const HazardResult result = detector_.step(noise_.apply(exact, camera_, 0.2, 0.0), camera_);
  EXPECT_EQ(result.status, Status::kClear);
  EXPECT_EQ(map(result).at(1.25, 0.05), Cell::kUnseen);
  EXPECT_EQ(map(result).at(3.05, 0.05), Cell::kFree);
}

TEST_F(HazardDetectorTest, HolesAreHazards) {
  for (double depth : {0.3, 0.5})
    for (double x : {1.5, 1.9, 2.3}) {
      synthetic::World world;
      world.pits.push_back({x, 0.0, 0.4, depth});
      const HazardResult result = detect(world);
      EXPECT_EQ(result.status, Status::kHazard) << x << " " << depth;
      EXPECT_GT(map(result).count(Cell::kHole), 3) << x << " " << depth;
      EXPECT_EQ(map(result).at(x, 0.0) == Cell::kFree, false) << x << " " << depth;
    }
}

// A step across the whole view, 0.02 m wide.
synthetic::World step_edge(double x_m, double rise_m) {
  synthetic::World world;
  world.relief = [x_m, rise_m](double x, double) { return rise_m / (1.0 + std::exp(-(x - x_m) / 0.005)); };
  return world;
}

TEST_F(HazardDetectorTest, StepUpAcrossTheWholeViewIsAHazard) {
  for (double x_m : {1.4, 1.8, 2.3}) {
    const HazardResult result = detect(step_edge(x_m, 0.2));
    EXPECT_EQ(result.status, Status::kHazard) << x_m;
    for (double y = -0.35; y < 0.4; y += 0.1)
      EXPECT_GT(map(result).count_near(is_hazard, x_m, y, 0.15), 0) << x_m << " " << y;
  }
}

// The ground behind the edge is occluded: a barrier of unseen or hazard cells blocks every path.
TEST_F(HazardDetectorTest, StepDownAcrossTheWholeViewIsNeverFree) {
  for (double x_m : {1.4, 1.8, 2.3}) {
    const HazardResult result = detect(step_edge(x_m, -0.3));
    const double hidden_m = 0.3 * (x_m - 0.527) / 0.679;
    for (double x = x_m + 0.1; x < x_m + hidden_m - 0.1; x += 0.1)
      for (double y = -0.35; y < 0.4; y += 0.1) EXPECT_NE(map(result).at(x, y), Cell::kFree) << x << " " << y;
  }
}

TEST_F(HazardDetectorTest, BoulderThatFillsTheViewIsNotFittedAsGround) {
  for (double x : {1.4, 1.7, 2.0}) {
    synthetic::World world;
    world.rocks.push_back({x, 0.0, 0.5, 0.35, true});
    const HazardResult result = detect(world);
    EXPECT_EQ(result.status, Status::kHazard) << x;
    EXPECT_GT(map(result).count_near(is_hazard, x, 0.0, 0.5), 40) << x;
    EXPECT_NEAR(result.plane.offset_m, 0.0, 0.03) << x;
  }
}

TEST_F(HazardDetectorTest, WallCloseAheadIsHazardOrBlindNeverClear) {
  for (double x : {1.1, 1.3, 1.6}) {
    synthetic::World world;
    world.rocks.push_back({x + 2.0, 0.0, 2.0, 1.0, true});
    const HazardResult result = detect(world);
    EXPECT_NE(result.status, Status::kClear) << x;
    EXPECT_EQ(map(result).count_near(Cell::kFree, x + 0.5, 0.0, 0.3), 0) << x;
  }
}

TEST_F(HazardDetectorTest, StereoOutliersAreNotAHazard) {
  auto exact = synthetic::exact_disparity({}, camera_);
  std::mt19937_64 random(5);
  for (int k = 0; k < 400; ++k) exact[random() % exact.size()] += 10.0f;
  EXPECT_EQ(detector_.step(noise_.apply(exact, camera_, 0.2, 0.05), camera_).status, Status::kClear);
}

TEST_F(HazardDetectorTest, FramesAreIndependent) {
  synthetic::World rock;
  rock.rocks.push_back({1.6, 0.0, 0.2, 0.25});
  const auto with = noise_.apply(synthetic::exact_disparity(rock, camera_), camera_, 0.2, 0.05);
  const auto without = noise_.apply(synthetic::exact_disparity({}, camera_), camera_, 0.2, 0.05);
  const HazardResult first = detector_.step(with, camera_);
  EXPECT_EQ(first.status, Status::kHazard);
  EXPECT_EQ(detector_.step(without, camera_).status, Status::kClear);
  const HazardResult again = detector_.step(with, camera_);
  EXPECT_EQ(again.cells, first.cells);
  EXPECT_EQ(again.plane.slope_x, first.plane.slope_x);
}

TEST_F(HazardDetectorTest, AnotherCameraRebuildsTheTable) {
  StereoCamera steep = camera_;
  steep.T_body_cam.linear() = camera_rotation(to_rad(40.0));
  const auto exact = synthetic::exact_disparity({}, steep);
  detector_.step(noise_.apply(exact, camera_, 0.2, 0.0), camera_);
  const HazardResult result = detector_.step(noise_.apply(exact, steep, 0.2, 0.0), steep);
  EXPECT_NEAR(result.plane.pitch_rad(), 0.0, to_rad(0.3));
  EXPECT_EQ(result.status, Status::kClear);
}

TEST_F(HazardDetectorTest, CalibrationReplacesTheMount) {
  // The true camera is 0.02 m higher and pitched down by 1 deg more than its nominal mount.
  StereoCamera actual = camera_;
  actual.T_body_cam.translation().z() += 0.02;
  actual.T_body_cam.linear() = camera_rotation(to_rad(34.0));
  HazardConfig config;
  config.calibration = nominal_calibration(actual, config.origin_height_m);
  HazardDetector calibrated(config);
  const HazardResult result =
      calibrated.step(noise_.apply(synthetic::exact_disparity({}, actual), camera_, 0.2, 0.0), camera_);
  EXPECT_NEAR(result.plane.pitch_rad(), 0.0, to_rad(0.1));
  EXPECT_NEAR(result.plane.offset_m, 0.0, 0.005);
  const HazardResult nominal =
      detector_.step(noise_.apply(synthetic::exact_disparity({}, actual), camera_, 0.2, 0.0), camera_);
  EXPECT_GT(std::abs(nominal.plane.pitch_rad()), to_rad(0.5));
}

}  // namespace
}  // namespace rover::hazard
