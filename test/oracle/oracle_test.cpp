// Shortest drivable paths on ground of known shape.
#include "tools/oracle/oracle.hpp"

#include <gtest/gtest.h>

#include "rover_simulator/world/world.hpp"
#include "vehicle.hpp"

namespace rover::oracle {
namespace {

constexpr double kToleranceM = 0.5;

// On a map of 60 x 40 m, from (10, 20) to (50, 20) unless changed.
Request request_on(HeightFunction height_m) {
  return {.height_m = std::move(height_m),
          .map_width_m = 60.0,
          .map_length_m = 40.0,
          .vehicle = test_vehicle(),
          .start = {10.0, 20.0, 0.0},
          .planned = {{10.0, 20.0}, {50.0, 20.0}},
          .goal_tolerance_m = kToleranceM};
}

double flat(double, double) {
  return 0.0;
}

// Across the whole map at x = 30, with an opening of this width at y = 20, and a block in its middle.
HeightFunction wall_with_opening(double opening_m, double block_height_m, double block_width_m) {
  return [=](double x_m, double y_m) {
    if (std::abs(x_m - 30.0) > 0.1) return 0.0;
    const double off_m = std::abs(y_m - 20.0);
    return off_m > 0.5 * opening_m ? 0.5 : off_m < 0.5 * block_width_m ? block_height_m : 0.0;
  };
}

TEST(Oracle, FreeGroundGivesTheStraightLine) {
  const Result result = shortest_path(request_on(flat));
  ASSERT_EQ(result.status, Status::kFound);
  EXPECT_NEAR(result.length_m, 40.0 - kToleranceM, 0.002 * 40.0);
}

TEST(Oracle, StraightLineInAnyDirectionAndFromAnyHeading) {
  for (const double yaw_rad : {0.0, 0.7, 2.0, -2.9}) {
    Request request = request_on(flat);
    request.start = {10.0, 10.0, yaw_rad};
    request.planned = {{10.0, 10.0}, {43.0, 27.0}};
    const Result result = shortest_path(request);
    ASSERT_EQ(result.status, Status::kFound);
    const double line_m = std::hypot(33.0, 17.0) - kToleranceM;
    EXPECT_GE(result.length_m, line_m - 1e-3);
    EXPECT_LE(result.length_m, 1.002 * line_m) << yaw_rad;
  }
}

TEST(Oracle, WallOfKnownExtentIsPassedAtItsEnd) {
  const Result result = shortest_path(
      request_on([](double x_m, double y_m) { return std::abs(x_m - 30.0) < 0.05 && y_m < 23.0 ? 0.5 : 0.0; }));
  ASSERT_EQ(result.status, Status::kFound);
  // A taut string about a disc of half the rover's width at the end of the wall.
  const double radius_m = 0.47;
  const double reach_m = std::hypot(20.0, 3.0);
  const double shortest_m = 2.0 * std::sqrt(reach_m * reach_m - radius_m * radius_m) +
                            2.0 * radius_m * (std::atan2(3.0, 20.0) + std::asin(radius_m / reach_m)) - kToleranceM;
  EXPECT_GE(result.length_m, 0.998 * shortest_m);
  EXPECT_LE(result.length_m, 1.01 * shortest_m);
}

TEST(Oracle, BlockBetweenTheWheelsIsStraddled) {
  const Result result = shortest_path(request_on(wall_with_opening(1.05, 0.18, 0.5)));
  ASSERT_EQ(result.status, Status::kFound);
  EXPECT_NEAR(result.length_m, 40.0 - kToleranceM, 0.002 * 40.0);
}

TEST(Oracle, BlockUnderAWheelOrTooTallForTheBellyClosesTheOpening) {
  EXPECT_EQ(shortest_path(request_on(wall_with_opening(1.05, 0.18, 0.8))).status, Status::kNoPath);
  EXPECT_EQ(shortest_path(request_on(wall_with_opening(1.05, 0.25, 0.5))).status, Status::kNoPath);
  EXPECT_EQ(shortest_path(request_on(wall_with_opening(0.85, 0.0, 0.0))).status, Status::kNoPath);
}

TEST(Oracle, ClosedWallHasNoPath) {
  const Result result = shortest_path(request_on(wall_with_opening(0.0, 0.0, 0.0)));
  EXPECT_EQ(result.status, Status::kNoPath);
  EXPECT_TRUE(std::isnan(result.length_m));
  EXPECT_TRUE(result.path.empty());
}

TEST(Oracle, PathDoesNotLeaveTheMap) {
  const auto wall = [](double x_m, double y_m) { return std::abs(x_m - 30.0) < 0.1 && y_m < 38.0 ? 0.5 : 0.0; };
  Request request = request_on(wall);
  EXPECT_EQ(shortest_path(request).status, Status::kFound);
  request.map_length_m = 38.2;
  EXPECT_EQ(shortest_path(request).status, Status::kNoPath);
}

TEST(Oracle, StartOnAHazardIsBlocked) {
  const auto block = [](double x_m, double y_m) { return std::hypot(x_m - 10.6, y_m - 20.0) < 0.2 ? 0.4 : 0.0; };
  EXPECT_EQ(shortest_path(request_on(block)).status, Status::kStartBlocked);
}

TEST(Oracle, SlotWithoutRoomToTurnIsLeftInReverse) {
  const auto slot = [](double x_m, double y_m) {
    const bool wall = x_m > 7.0 && x_m < 11.5 && std::abs(y_m - 20.0) < 0.8;
    return wall && !(x_m < 11.2 && std::abs(y_m - 20.0) < 0.55) ? 0.5 : 0.0;
  };
  const Result result = shortest_path(request_on(slot));
  ASSERT_EQ(result.status, Status::kFound);
  EXPECT_LT(result.path.front().driven_m, 0.0);
  EXPECT_GT(result.length_m, 40.0 + 2.0 * (10.0 - 7.0));
}

TEST(Oracle, LedgeBlocksAndLowStepDoesNot) {
  const auto ledge = [](double height_m) {
    return request_on([=](double x_m, double) { return x_m > 30.0 ? height_m : 0.0; });
  };
  EXPECT_EQ(shortest_path(ledge(0.25)).status, Status::kNoPath);
  EXPECT_EQ(shortest_path(ledge(-0.25)).status, Status::kNoPath);
  EXPECT_EQ(shortest_path(ledge(0.10)).status, Status::kFound);
}

TEST(Oracle, SlopeAboveTheLimitBlocks) {
  const auto ramp = [](double slope_deg) {
    return request_on([=](double x_m, double y_m) { return std::tan(to_rad(slope_deg)) * (0.6 * x_m + 0.8 * y_m); });
  };
  const Result gentle = shortest_path(ramp(15.0));
  ASSERT_EQ(gentle.status, Status::kFound);
  EXPECT_NEAR(gentle.length_m, 40.0 - kToleranceM, 0.002 * 40.0);
  EXPECT_EQ(shortest_path(ramp(21.0)).status, Status::kStartBlocked);
}

TEST(Oracle, BentPathIsCutWithinItsCorridorOnly) {
  Request request = request_on(flat);
  request.start = {10.0, 10.0, 0.0};
  request.planned = {{10.0, 10.0}, {30.0, 10.0}, {30.0, 30.0}};
  const Result result = shortest_path(request);
  ASSERT_EQ(result.status, Status::kFound);
  EXPECT_NEAR(result.length_m, 2.0 * std::hypot(18.5, 1.5) - kToleranceM, 0.01 * 40.0);
}

// Largest rocks below the wheels and below the footprint.
struct Crossed {
  double wheels_m = 0.0;
  double body_m = 0.0;

  void add(const World& world, const Vehicle& vehicle, const Pose2& pose) {
    const auto rock_m = [&](double x_m, double y_m) {
      const double c = std::cos(pose.yaw_rad);
      const double s = std::sin(pose.yaw_rad);
      return world.material(pose.x_m + c * x_m - s * y_m, pose.y_m + s * x_m + c * y_m).rock_height_m;
    };
    for (double x = -0.85; x <= 0.851; x += 0.05)
      for (double y = -0.44; y <= 0.441; y += 0.04) body_m = std::max(body_m, rock_m(x, y));
    for (size_t i = 0; i < vehicle.wheel_x_m.size(); ++i)
      for (double x = -0.1; x <= 0.101; x += 0.025)
        for (double y = -0.03; y <= 0.031; y += 0.03)
          wheels_m = std::max(wheels_m, rock_m(vehicle.wheel_x_m[i] + x, vehicle.wheel_y_m[i] + y));
  }
};

// The rocks' heights are known without the estimate of the local ground.
TEST(Oracle, PathOverSimulatedRocksKeepsTheLimits) {
  for (const double k : {0.12, 0.25}) {
    WorldConfig config;
    config.rocks.k = k;
    config.keep_clear = {{10.0, 20.0, 1.5}, {50.0, 20.0, 1.0}};
    const World world(config, plane_raster(60.0, 40.0, 1.0, to_rad(8.0), to_rad(30.0)), 3);
    const Request request = request_on([&](double x_m, double y_m) { return world.height_m(x_m, y_m); });
    const Result result = shortest_path(request);
    ASSERT_EQ(result.status, Status::kFound);
    Crossed crossed;
    for (const Piece& piece : result.path) {
      const int n = static_cast<int>(piece.length_m() / 0.03) + static_cast<int>(std::abs(piece.turn_rad) / 0.03) + 1;
      for (int i = 0; i <= n; ++i) crossed.add(world, request.vehicle, piece.pose_at(static_cast<double>(i) / n));
    }
    constexpr double kErrorM =
        0.015;  // of the local ground; the cells' 3 cm are left out at the rims of wheels and footprint
    EXPECT_LT(crossed.wheels_m, 0.15 + kErrorM);
    EXPECT_LT(crossed.body_m, 0.20 + kErrorM);
  }
}

TEST(Oracle, SameRequestGivesTheSamePath) {
  WorldConfig config;
  config.rocks.k = 0.10;
  const World world(config, plane_raster(60.0, 40.0, 1.0, 0.0, 0.0), 4);
  Request request = request_on([&](double x_m, double y_m) { return world.height_m(x_m, y_m); });
  request.start = {10.0, 20.0, 0.1};
  const Result first = shortest_path(request);
  EXPECT_EQ(first.length_m, shortest_path(request).length_m);
}

}  // namespace
}  // namespace rover::oracle
