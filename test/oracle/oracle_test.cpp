// Shortest drivable paths on ground of known shape.
#include "tools/oracle/oracle.hpp"

#include <gtest/gtest.h>

#include "rover_simulator/world/world.hpp"
#include "tools/oracle/shorten.hpp"
#include "vehicle.hpp"

namespace rover::oracle {
namespace {

constexpr double kToleranceM = 0.5;

double flat(double, double) {
  return 0.0;
}

// On a map of 60 x 40 m, from (10, 20) to (50, 20) unless changed.
Request request_on(HeightFunction height_m, HeightFunction ground_m = flat) {
  return {.height_m = std::move(height_m),
          .ground_m = std::move(ground_m),
          .map_width_m = 60.0,
          .map_length_m = 40.0,
          .vehicle = test_vehicle(),
          .start = {10.0, 20.0, 0.0},
          .planned = {{10.0, 20.0}, {50.0, 20.0}},
          .goal_tolerance_m = kToleranceM};
}

Request request_on(const World& world) {
  return request_on([&](double x_m, double y_m) { return world.height_m(x_m, y_m); },
                    [&](double x_m, double y_m) { return world.ground_height_m(x_m, y_m); });
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

// As the wall of known extent.
TEST(Oracle, AZoneIsPassedAtItsEnd) {
  Request request = request_on(flat);
  request.zones = {{"dune", false, {{29.9, 17.0}, {30.1, 17.0}, {30.1, 30.0}, {29.9, 30.0}}}};
  const Result around = shortest_path(request);
  ASSERT_EQ(around.status, Status::kFound);
  EXPECT_GT(around.length_m, shortest_path(request_on(flat)).length_m + 0.3);
  for (const Eigen::Vector2d& p : points_of(around.path, 0.05))
    EXPECT_FALSE(forbidding_zone(request.zones, p)) << p.transpose();
  request.zones = {{"site", true, {{5.0, 15.0}, {25.0, 15.0}, {25.0, 25.0}, {5.0, 25.0}}}};
  EXPECT_EQ(shortest_path(request).status, Status::kNoPath);
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

// The local ground at the edge of a step is half way up.
TEST(Oracle, LedgeOfTheGroundBlocksAndLowStepDoesNot) {
  const auto ledge = [](double height_m) {
    const auto step = [=](double x_m, double) { return x_m > 30.0 ? height_m : 0.0; };
    return request_on(step, step);
  };
  EXPECT_EQ(shortest_path(ledge(0.6)).status, Status::kNoPath);
  EXPECT_EQ(shortest_path(ledge(-0.6)).status, Status::kNoPath);
  EXPECT_EQ(shortest_path(ledge(0.10)).status, Status::kFound);
}

// Through a wall 3 m thick, at an angle between two of 15 deg.
TEST(Oracle, ObliqueCorridorIsPassed) {
  for (const double angle_deg : {7.5, -22.5}) {
    const double c = std::cos(to_rad(angle_deg));
    const double s = std::sin(to_rad(angle_deg));
    const auto wall = [=](double x_m, double y_m) {
      const double along_m = c * (x_m - 30.0) + s * (y_m - 20.0);
      const double off_m = c * (y_m - 20.0) - s * (x_m - 30.0);
      return std::abs(along_m) < 1.5 && std::abs(off_m) > 0.55 ? 0.5 : 0.0;
    };
    const Result result = shortest_path(request_on(wall));
    ASSERT_EQ(result.status, Status::kFound) << angle_deg;
    EXPECT_LT(result.length_m, 40.5) << angle_deg;
  }
}

// The way around the wall is outside the corridor: two regions are searched.
TEST(Oracle, ExpansionsOfAllRegionsAreLimitedTogether) {
  Request request =
      request_on([](double x_m, double y_m) { return std::abs(x_m - 30.0) < 0.05 && y_m < 23.3 ? 0.5 : 0.0; });
  request.max_expansions = 100;
  const Result result = shortest_path(request);
  EXPECT_EQ(result.status, Status::kGaveUp);
  EXPECT_LE(result.expansions, 103) << "one more a region";
}

// The goal is straight ahead behind a block at the right side; the search drove past it in an arc.
TEST(Shorten, LineToTheGoalIsCheckedThoughItJoinsNeighbouringPoses) {
  const Vehicle vehicle = test_vehicle();
  TrueGround ground([](double x_m, double y_m) { return std::hypot(x_m - 11.05, y_m - 19.55) < 0.06 ? 0.5 : 0.0; },
                    flat, {});
  const FootprintCheck check(vehicle, ground);
  const Region region = region_around({{10.0, 20.0}, {12.0, 20.0}}, 2.0, 60.0, 40.0);
  const Eigen::Vector2d goal(10.75, 20.0);
  const CostToGo cost_to_go(region, check, goal, kToleranceM, 0.0);
  const SearchProblem problem{.region = region,
                              .check = check,
                              .cost_to_go = cost_to_go,
                              .max_curvature_per_m = 1.0,
                              .start = {10.0, 20.0, 0.0},
                              .goal = goal,
                              .tolerance_m = kToleranceM};
  const Piece arc{problem.start, 0.3, 1.0, 0.0};
  ASSERT_TRUE(check.is_free(arc));
  ASSERT_FALSE(check.is_free(Piece{problem.start, 0.25, 0.0, 0.0}));
  for (const Piece& piece : shortened({arc}, problem)) EXPECT_TRUE(check.is_free(piece));
}

TEST(Oracle, SlopeAboveTheLimitBlocks) {
  const auto ramp = [](double slope_deg) {
    const auto plane = [=](double x_m, double y_m) { return std::tan(to_rad(slope_deg)) * (0.6 * x_m + 0.8 * y_m); };
    return request_on(plane, plane);
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
    const World world(config, plane_raster(60.0, 40.0, 1.0, to_rad(8.0), to_rad(30.0)), 1);
    const Request request = request_on(world);
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
  Request request = request_on(world);
  request.start = {10.0, 20.0, 0.1};
  const Result first = shortest_path(request);
  EXPECT_EQ(first.length_m, shortest_path(request).length_m);
}

}  // namespace
}  // namespace rover::oracle
