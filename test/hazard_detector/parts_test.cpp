// Unit tests of the parts of the hazard detector against oracles.
#include <gtest/gtest.h>

#include <random>

#include "hazard_detector/cell_classifier.hpp"
#include "hazard_detector/disparity_table.hpp"
#include "hazard_detector/ground_plane.hpp"
#include "hazard_detector/local_ground.hpp"
#include "test/hazard_detector/scene.hpp"

namespace rover::hazard {
namespace {

TEST(DisparityTableTest, TableMatchesTheDisparityOfFlatGround) {
  const StereoCamera camera = synthetic::loccam_camera();
  const DisparityTable table(camera, HazardConfig{});
  const auto exact = synthetic::exact_disparity({}, camera);
  EXPECT_NEAR(table.height_m(), 0.679, 1e-12);
  ASSERT_GT(table.samples().size(), 20000u);
  for (const Sample& s : table.samples()) {
    const float truth = exact[static_cast<size_t>(s.index)];
    if (truth > 0.0f) {
      ASSERT_NEAR(s.d_cal_px16, 16.0f * truth, 0.01f);
    }
    ASSERT_EQ(s.index, static_cast<int>(s.v) * camera.width + static_cast<int>(s.u));
  }
}

TEST(DisparityTableTest, SamplesAreSpreadEvenlyOverTheGround) {
  const StereoCamera camera = synthetic::loccam_camera();
  const DisparityTable table(camera, HazardConfig{});
  const GridShape shape{GridConfig{}};
  std::vector<int> count(static_cast<size_t>(shape.size()), 0);
  for (const Sample& s : table.samples()) {
    const Eigen::Vector3d p = camera.T_body_cam * camera.point(s.u, s.v, s.d_cal_px16 / 16.0);
    const int ix = static_cast<int>((p.x() - shape.origin_x_m) / 0.1), iy = static_cast<int>((p.y() + 2.0) / 0.1);
    if (shape.contains(ix, iy)) ++count[static_cast<size_t>(shape.at(ix, iy))];
  }
  for (double x = 1.15; x < 3.0; x += 0.1) {
    const int ix = static_cast<int>((x - shape.origin_x_m) / 0.1);
    EXPECT_GE(count[static_cast<size_t>(shape.at(ix, 20))], 10) << x;
    EXPECT_LE(count[static_cast<size_t>(shape.at(ix, 20))], 220) << x;
  }
}

GroundPoints plane_points(double offset, double sx, double sy, std::mt19937_64& random) {
  std::normal_distribution<double> noise(0.0, 0.01);
  GroundPoints points;
  for (double x = 1.0; x < 3.5; x += 0.1)
    for (double y = -0.5; y < 0.5; y += 0.1)
      points.push_back({static_cast<float>(x), static_cast<float>(y),
                        static_cast<float>(offset + sx * (x - 0.75) + sy * y + noise(random))});
  return points;
}

TEST(GroundPlaneTest, FindsPlanesWithinTheBounds) {
  std::mt19937_64 random(3);
  for (double offset : {-0.1, 0.0, 0.1})
    for (double sx : {-0.18, 0.0, 0.18})
      for (double sy : {-0.15, 0.0, 0.15}) {
        const GroundPlane plane = fit_ground_plane(plane_points(offset, sx, sy, random), PlanePrior{});
        EXPECT_TRUE(plane.measured);
        EXPECT_NEAR(plane.offset_m, offset, 0.01);
        EXPECT_NEAR(plane.slope_x, sx, 0.01);
        EXPECT_NEAR(plane.slope_y, sy, 0.02);
      }
}

TEST(GroundPlaneTest, FortyPercentOutlierCellsDoNotBiasThePlane) {
  std::mt19937_64 random(4);
  GroundPoints points = plane_points(0.0, 0.05, 0.0, random);
  for (size_t i = 0; i < points.size(); ++i)
    if (i % 5 < 2) points[i].z_m += 0.1f + 0.05f * static_cast<float>(i % 7);
  const GroundPlane plane = fit_ground_plane(points, PlanePrior{});
  EXPECT_NEAR(plane.offset_m, 0.0, 0.02);
  EXPECT_NEAR(plane.slope_x, 0.05, 0.02);
}

TEST(GroundPlaneTest, PlaneStaysWithinTheBoundsAndNeedsMinCells) {
  std::mt19937_64 random(5);
  const PlanePrior prior;
  const GroundPlane steep = fit_ground_plane(plane_points(0.4, 0.6, -0.6, random), prior);
  EXPECT_LE(std::abs(steep.offset_m), prior.max_offset_m + 1e-12);
  EXPECT_LE(std::abs(steep.slope_x), std::tan(prior.max_slope_rad) + 1e-12);
  EXPECT_LE(std::abs(steep.slope_y), std::tan(prior.max_slope_rad) + 1e-12);
  GroundPoints few = plane_points(0.1, 0.1, 0.1, random);
  few.resize(static_cast<size_t>(prior.min_cells - 1));
  const GroundPlane none = fit_ground_plane(few, prior);
  EXPECT_FALSE(none.measured);
  EXPECT_EQ(none.slope_x, 0.0);
}

TEST(LocalGroundTest, FollowsASmoothRiseButNotARock) {
  const GridShape shape{GridConfig{}};
  std::vector<float> heights(static_cast<size_t>(shape.size()));
  for (int iy = 0; iy < shape.cells_y; ++iy)
    for (int ix = 0; ix < shape.cells_x; ++ix) {
      const double x = shape.x_m(ix), y = shape.y_m(iy);
      heights[static_cast<size_t>(shape.at(ix, iy))] = static_cast<float>(
          0.08 * std::exp(-(x - 2.5) * (x - 2.5) / 0.8) + (std::hypot(x - 2.0, y) < 0.2 ? 0.25 : 0.0));
    }
  const LocalGround ground = estimate_local_ground(heights, shape, LocalGroundConfig{}, 0.75);
  const size_t rock = static_cast<size_t>(shape.at(15, 20)), crest = static_cast<size_t>(shape.at(20, 35));
  EXPECT_LT(ground.low_m[rock], 0.08f);
  EXPECT_GT(heights[rock] - ground.low_m[rock], 0.2f);
  EXPECT_NEAR(ground.low_m[crest], 0.06f, 0.025f);
}

TEST(LocalGroundTest, IsNotHigherThanTheLowestNeighbourCell) {
  const GridShape shape{GridConfig{}};
  std::mt19937_64 random(9);
  std::uniform_real_distribution<float> height(-0.05f, 0.4f);
  std::vector<float> heights(static_cast<size_t>(shape.size()));
  for (float& h : heights) h = height(random);
  const LocalGroundConfig config;
  const LocalGround ground = estimate_local_ground(heights, shape, config, 0.75);
  for (int iy = 0; iy < shape.cells_y; ++iy)
    for (int ix = 0; ix < shape.cells_x; ++ix) {
      float lowest = 1.0f;
      for (int y = iy - 2; y <= iy + 2; ++y)
        for (int x = ix - 2; x <= ix + 2; ++x)
          if (shape.contains(x, y)) lowest = std::min(lowest, heights[static_cast<size_t>(shape.at(x, y))]);
      ASSERT_LE(ground.low_m[static_cast<size_t>(shape.at(ix, iy))], lowest + config.step_tolerance_m + 1e-6);
    }
}

TEST(LocalGroundTest, DeviationFromThePlaneIsBoundedByTheDistance) {
  const GridShape shape{GridConfig{}};
  const LocalGroundConfig config;
  const std::vector<float> plateau(static_cast<size_t>(shape.size()), 0.5f), unseen(plateau.size(), NAN);
  const LocalGround high = estimate_local_ground(plateau, shape, config, 0.75);
  for (int ix = 0; ix < shape.cells_x; ++ix) {
    const double ahead = std::max(0.0, shape.x_m(ix) + config.node_m - 0.75);
    EXPECT_LE(high.low_m[static_cast<size_t>(shape.at(ix, 10))],
              config.max_deviation_m + config.max_deviation_m_per_m * ahead + 1e-6);
  }
  for (float height : estimate_local_ground(unseen, shape, config, 0.75).low_m) EXPECT_EQ(height, 0.0f);
}

class CellClassifierTest : public testing::Test {
 protected:
  CellClassifierTest() : evidence_(static_cast<size_t>(shape_.size())) {
    for (CellEvidence& e : evidence_) e = {.measured = 25, .expected = 25, .over = 25, .over_seen = 25};
  }
  CellEvidence& at(int ix, int iy) { return evidence_[static_cast<size_t>(shape_.at(ix, iy))]; }
  Cell state(int ix, int iy) const {
    return classify_cells(evidence_, shape_, config_)[static_cast<size_t>(shape_.at(ix, iy))];
  }

  GridShape shape_{GridConfig{}};
  HazardConfig config_;
  std::vector<CellEvidence> evidence_;
};

TEST_F(CellClassifierTest, FreeNeedsMostOfTheExpectedSamples) {
  for (int ix : {10, 11}) at(ix, 10).measured = 13;
  for (int ix : {20, 21, 22}) at(ix, 10).measured = 12;
  EXPECT_EQ(state(10, 10), Cell::kFree);
  EXPECT_EQ(state(21, 10), Cell::kUnseen);
}

TEST_F(CellClassifierTest, CellWithoutOwnSamplesIsNotFreeByItsNeighbours) {
  for (int ix : {10, 11, 12, 20, 21, 22})
    for (int iy = 0; iy < shape_.cells_y; ++iy) at(ix, iy) = {.measured = 6, .expected = 6};
  for (int ix : {10, 11, 12}) at(ix, 10).measured = 0;
  for (int ix : {20, 21, 22}) at(ix, 10).measured = 1;
  EXPECT_EQ(state(11, 10), Cell::kUnseen);
  EXPECT_EQ(state(21, 10), Cell::kFree);
}

// Near, and far, where cells are sparse: a rock may stand on the part beyond the rim.
TEST_F(CellClassifierTest, CellCutByTheRimOfThePictureIsNotFree) {
  for (const int whole : {60, 6}) {
    for (int ix = 0; ix < shape_.cells_x; ++ix) {
      for (int iy = 0; iy < 10; ++iy) at(ix, iy) = {.measured = whole, .expected = whole};
      at(ix, 10) = {.measured = whole / 3, .expected = whole / 3};
      at(ix, 11) = {.measured = 1, .expected = 1};
      for (int iy = 12; iy < shape_.cells_y; ++iy) at(ix, iy) = {};
    }
    EXPECT_EQ(state(20, 9), Cell::kFree) << whole;
    EXPECT_EQ(state(20, 10), Cell::kUnseen) << whole;
    EXPECT_EQ(state(20, 11), Cell::kUnseen) << whole;
  }
}

TEST_F(CellClassifierTest, OnlyASingleGapIsFilled) {
  at(10, 10).measured = 0;
  for (int ix : {20, 21, 22}) at(ix, 10).measured = 0;
  EXPECT_EQ(state(10, 10), Cell::kFree);
  EXPECT_EQ(state(21, 10), Cell::kUnseen);
}

TEST_F(CellClassifierTest, HazardClusterNeedsMinSamples) {
  at(10, 10).high = at(10, 10).tall = 11;
  EXPECT_FALSE(is_hazard(state(10, 10)));
  at(11, 11).high = 3;
  EXPECT_EQ(state(10, 10), Cell::kObstacle);
  EXPECT_EQ(state(11, 11), Cell::kObstacle);
  EXPECT_EQ(state(12, 12), Cell::kMargin);
  EXPECT_EQ(state(13, 13), Cell::kFree);
}

TEST_F(CellClassifierTest, UnseenGroundBesideAHazardStaysUnseen) {
  at(10, 10).high = at(10, 10).tall = 20;
  for (int ix : {10, 11, 12})
    for (int iy : {11, 12}) at(ix, iy).measured = 0;
  EXPECT_EQ(state(11, 11), Cell::kUnseen);
  EXPECT_EQ(state(9, 9), Cell::kMargin);
}

TEST_F(CellClassifierTest, ObstacleGrowsOverItsSidesAndHolesAreDetected) {
  at(10, 10).high = at(10, 10).tall = 20;
  at(11, 10).raised = 5;
  at(20, 20).low = 20;
  EXPECT_EQ(state(11, 10), Cell::kObstacle);
  EXPECT_EQ(state(20, 20), Cell::kHole);
}

TEST_F(CellClassifierTest, AnObstacleIsLowIfHardlyAnySampleOfItIsTall) {
  for (int ix : {10, 11, 12}) at(ix, 10).high = 20;
  at(12, 10).tall = config_.min_cell_samples - 1;
  for (int ix : {20, 21, 22}) at(ix, 20).high = 20;
  at(22, 20).tall = config_.min_cell_samples;
  for (int ix : {10, 11, 12}) EXPECT_EQ(state(ix, 10), Cell::kLow) << ix;
  for (int ix : {20, 21, 22}) EXPECT_EQ(state(ix, 20), Cell::kObstacle) << ix;
}

TEST_F(CellClassifierTest, AnObstacleIsLowOnlyIfTheRaysOverItAreMeasured) {
  for (int ix : {10, 11, 12}) at(ix, 10).high = 20, at(ix, 10).over_seen = 12;
  for (int ix : {20, 21, 22}) at(ix, 20).high = 20, at(ix, 20).over = 0, at(ix, 20).over_seen = 0;
  for (int ix : {10, 11, 12}) EXPECT_EQ(state(ix, 10), Cell::kObstacle) << ix;
  for (int ix : {20, 21, 22}) EXPECT_EQ(state(ix, 20), Cell::kObstacle) << ix;
}

}  // namespace
}  // namespace rover::hazard
