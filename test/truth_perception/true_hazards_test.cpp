#include "tools/truth_perception/true_hazards.hpp"

#include <gtest/gtest.h>

#include "common/core/frames.hpp"
#include "test/stereo/synthetic_world.hpp"
#include "test/truth_perception/scene.hpp"

namespace rover::truth {
namespace {

using hazard::Cell;

// A rover at (20, 30), heading 0.6 rad; blocks in its axes.
class TrueHazardsTest : public testing::Test {
 protected:
  static constexpr double kYawRad = 0.6;

  hazard::HazardResult look(const std::vector<Block>& blocks) {
    in_body_ = blocks;
    const double c = std::cos(kYawRad), s = std::sin(kYawRad);
    world_.blocks.clear();
    for (const Block& b : blocks)
      world_.blocks.push_back({20.0 + c * b.x_m - s * b.y_m, 30.0 + s * b.x_m + c * b.y_m, b.radius_m, b.height_m});
    TrueHazards hazards({}, synthetic::loccam_camera(), std::make_shared<TrueSurface>(world_));
    // On a slope along x the body's plane is that of the ground.
    const Eigen::Matrix3d tilt =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), Eigen::Vector3d(-world_.slope_x, 0.0, 1.0))
            .toRotationMatrix();
    const Eigen::Matrix3d R = tilt * rotation_from_rpy(0.0, 0.0, kYawRad);
    return hazards.step(make_pose(R, Eigen::Vector3d(20.0, 30.0, 20.0 * world_.slope_x) + 0.62 * R.col(2)));
  }
  template <class F>
  void for_each_cell(F&& f) const {
    for (int iy = 0; iy < shape_.cells_y; ++iy)
      for (int ix = 0; ix < shape_.cells_x; ++ix) f(shape_.at(ix, iy), shape_.x_m(ix), shape_.y_m(iy));
  }
  int count(const hazard::HazardResult& result, Cell state) const {
    return static_cast<int>(std::count(result.cells.begin(), result.cells.end(), state));
  }
  Cell at(const hazard::HazardResult& result, double x_m, double y_m) const {
    return result.cells[static_cast<size_t>(shape_.at(static_cast<int>((x_m - shape_.origin_x_m) / shape_.cell_m),
                                                      static_cast<int>((y_m - shape_.origin_y_m) / shape_.cell_m)))];
  }
  // Every cell on the rock is an obstacle, low or not, and no other is.
  void expect_marked_exactly(const hazard::HazardResult& result, const Block& rock) const {
    for_each_cell([&](int i, double x, double y) {
      const bool obstacle = hazard::is_hazard(result.cells[static_cast<size_t>(i)]);
      if (std::hypot(x - rock.x_m, y - rock.y_m) <= rock.radius_m) {
        EXPECT_TRUE(obstacle) << x << " " << y;
      }
      if (!touches(rock, x, y, shape_.cell_m + 0.04)) {
        EXPECT_FALSE(obstacle) << x << " " << y;
      }
    });
  }

  Blocks world_;
  std::vector<Block> in_body_;
  hazard::GridShape shape_{hazard::GridConfig{}};
};

TEST_F(TrueHazardsTest, RockOfFourteenCentimetresIsNotMarked) {
  for (const double ahead : {1.2, 1.8, 2.6, 3.4}) {
    const hazard::HazardResult result = look({{ahead, 0.1, 0.2, 0.14}});
    EXPECT_EQ(result.status, hazard::Status::kClear) << ahead;
    EXPECT_EQ(at(result, ahead, 0.1), Cell::kFree) << ahead;
  }
}

TEST_F(TrueHazardsTest, RockOfSixteenCentimetresIsMarkedAllOfItAndNothingMore) {
  for (const double ahead : {1.2, 1.8, 2.6, 3.4}) {
    const hazard::HazardResult result = look({{ahead, 0.1, 0.2, 0.16}});
    EXPECT_EQ(result.status, hazard::Status::kHazard) << ahead;
    EXPECT_NEAR(result.nearest_hazard_m, ahead - 0.2, 0.1);
    expect_marked_exactly(result, in_body_[0]);
  }
}

TEST_F(TrueHazardsTest, RockThatPassesUnderTheBodyIsLow) {
  for (const double ahead : {1.2, 1.8, 2.6}) {
    EXPECT_EQ(at(look({{ahead, 0.1, 0.2, 0.16}}), ahead, 0.1), Cell::kLow) << ahead;
    EXPECT_EQ(at(look({{ahead, 0.1, 0.2, 0.25}}), ahead, 0.1), Cell::kObstacle) << ahead;
  }
}

TEST_F(TrueHazardsTest, RockBehindATallerOneIsNotSeen) {
  const Block low{2.6, 0.0, 0.15, 0.25}, tall{1.6, 0.0, 0.4, 0.5};
  EXPECT_EQ(at(look({low}), low.x_m, low.y_m), Cell::kObstacle);
  const hazard::HazardResult hidden = look({tall, low});
  EXPECT_EQ(at(hidden, low.x_m, low.y_m), Cell::kUnseen);
  EXPECT_EQ(at(hidden, tall.x_m - 0.3, tall.y_m), Cell::kObstacle);
}

TEST_F(TrueHazardsTest, GroundInViewIsFreeOnALevelAndOnASlope) {
  for (const double slope_deg : {0.0, 10.0, -10.0}) {
    world_.slope_x = std::tan(to_rad(slope_deg));
    const hazard::HazardResult result = look({});
    EXPECT_EQ(result.status, hazard::Status::kClear) << slope_deg;
    EXPECT_EQ(count(result, Cell::kObstacle) + count(result, Cell::kHole), 0) << slope_deg;
    EXPECT_GT(count(result, Cell::kFree), 500) << slope_deg;
    EXPECT_EQ(result.coverage, 1.0);
  }
}

TEST_F(TrueHazardsTest, GroundOutsideTheViewIsUnseen) {
  const hazard::HazardResult result = look({});
  EXPECT_EQ(at(result, 1.0, 1.5), Cell::kUnseen);
  EXPECT_EQ(at(result, 1.0, -1.5), Cell::kUnseen);
  EXPECT_EQ(at(result, 3.0, 0.0), Cell::kFree);
}

TEST_F(TrueHazardsTest, PitThatTheCameraSeesIntoIsAHole) {
  const hazard::HazardResult result = look({{1.9, 0.0, 0.5, -0.4}});
  EXPECT_EQ(result.status, hazard::Status::kHazard);
  EXPECT_GT(count(result, Cell::kHole), 3);
}

}  // namespace
}  // namespace rover::truth
