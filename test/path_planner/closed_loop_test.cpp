// The planner in a closed loop with a rover of imperfect odometry, among rocks.
#include <gtest/gtest.h>

#include "test/path_planner/descent_planner.hpp"
#include "test/path_planner/maze.hpp"

namespace rover::planning {
namespace {

using testing_support::drive;
using testing_support::DriveConfig;
using testing_support::DriveResult;
using testing_support::planner_config;
using testing_support::Rock;
using testing_support::rock_field;

constexpr double kLengthM = 14.0;

DriveConfig drive_config(bool full) {
  DriveConfig config;
  config.planner = planner_config();
  config.camera.false_hit_rate = 0.01;
  config.full = full;
  config.timeout_s = 600.0;
  return config;
}

std::vector<Rock> rocks_around_path(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Rock> rocks = rock_field(0.06, {-4.0, -8.0}, {kLengthM + 4.0, 8.0}, 0.3, random);
  std::erase_if(rocks, [](const Rock& r) {
    return distance(r.p, {0.0, 0.0}) < 2.0 + r.radius_m || distance(r.p, {kLengthM, 0.0}) < 2.5 + r.radius_m;
  });
  rocks.push_back({{7.0, 0.1}, 0.3, 0.3});
  return rocks;
}

std::vector<Rock> rock_row(Point2 from, Point2 to) {
  std::vector<Rock> rocks;
  const int count = static_cast<int>(std::ceil(distance(from, to) / 0.3));
  for (int i = 0; i <= count; ++i) {
    const double u = static_cast<double>(i) / count;
    rocks.push_back({{from.x_m + u * (to.x_m - from.x_m), from.y_m + u * (to.y_m - from.y_m)}, 0.2, 0.3});
  }
  return rocks;
}

std::vector<Rock> joined(std::initializer_list<std::vector<Rock>> parts) {
  std::vector<Rock> rocks;
  for (const std::vector<Rock>& part : parts) rocks.insert(rocks.end(), part.begin(), part.end());
  return rocks;
}

// traverse_study drives more of them.
TEST(ClosedLoop, TheFootprintNeverEntersAZone) {
  int zones = 0, reached = 0;
  for (const bool full : {false, true})
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed));
      const std::vector<Point2> path = {{0.0, 0.0}, {kLengthM, 0.0}};
      DriveConfig config = drive_config(full);
      config.zones = testing_support::random_zones(path, 5, seed);
      zones += static_cast<int>(config.zones.size());
      const DriveResult r = drive(config, rocks_around_path(seed), path, seed);
      reached += r.reached ? 1 : 0;
      EXPECT_EQ(r.zone_depth_m, 0.0);
      EXPECT_FALSE(r.collided);
    }
  EXPECT_GT(zones, 8);
  EXPECT_GT(reached, 5);
}

TEST(SecondPlanner, IsChosenByItsName) {
  add_planner("descent", [](const HybridPlannerConfig& config) -> std::shared_ptr<const Planner> {
    return std::make_shared<testing_support::DescentPlanner>(config);
  });
  DriveConfig config = drive_config(false);
  config.planner.planner_name = "descent";
  const std::vector<Rock> rocks = {{{6.0, 0.2}, 0.3, 0.3}};
  const DriveResult r = drive(config, rocks, {{0.0, 0.0}, {kLengthM, 0.0}}, 1);
  EXPECT_TRUE(r.reached) << r.text;
  EXPECT_FALSE(r.collided);
  EXPECT_GT(r.replans, 0);
}

// maze_study drives many. From the third on: point turns that show the ground of a plan; two closed places in turn; an
// end too narrow by centimetres; a rover beside its plan, onto a hazard's cell; reversing to meet known ground (two).
TEST(Mazes, TheGoalIsReachedOrThereIsNoPath) {
  const std::vector<std::pair<int, std::uint64_t>> mazes = {{3, 1},   {3, 2},    {4, 3},    {4, 3015},
                                                            {3, 160}, {3, 1875}, {3, 1833}, {3, 1858}};
  for (const auto& [aside, seed] : mazes) {
    const testing_support::Maze maze = testing_support::random_maze(aside, seed);
    DriveConfig config;
    config.planner = planner_config();
    const DriveResult r = drive(config, maze.walls, maze.path, seed);
    EXPECT_EQ(testing_support::maze_problem(maze, r), "") << "maze " << seed << " of " << aside << " rooms aside";
  }
}

class ClosedLoopTest : public testing::TestWithParam<bool> {};

std::string level_name(const testing::TestParamInfo<bool>& info) {
  return info.param ? "Full" : "Efficient";
}

TEST_P(ClosedLoopTest, ReachesTheGoalWithoutCollision) {
  std::vector<double> ratios;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const DriveResult r =
        drive(drive_config(GetParam()), rocks_around_path(seed), {{0.0, 0.0}, {5.0, 0.6}, {kLengthM, 0.0}}, seed);
    EXPECT_TRUE(r.reached) << seed << ": " << r.text;
    EXPECT_FALSE(r.collided) << seed;
    EXPECT_GT(r.min_clearance_m, 0.0) << seed;
    ratios.push_back(r.driven_m / kLengthM);
  }
  std::sort(ratios.begin(), ratios.end());
  EXPECT_LT(ratios[ratios.size() / 2], 1.15);
}

TEST_P(ClosedLoopTest, LeavesAUShapeOfRocks) {
  const std::vector<Rock> rocks =
      joined({rock_row({2.5, -2.0}, {6.0, -2.0}), rock_row({6.0, -2.0}, {6.0, 2.0}), rock_row({6.0, 2.0}, {2.5, 2.0})});
  const DriveResult r = drive(drive_config(GetParam()), rocks, {{0.0, 0.0}, {12.0, 0.0}}, 1);
  EXPECT_TRUE(r.reached) << r.text;
  EXPECT_FALSE(r.collided);
}

TEST_P(ClosedLoopTest, EnclosedByRocksItSaysThatThereIsNoPath) {
  std::vector<Rock> rocks;
  for (int deg = 0; deg < 360; deg += 6)
    rocks.push_back({{2.0 * std::cos(to_rad(deg)), 2.0 * std::sin(to_rad(deg))}, 0.2, 0.3});
  const DriveConfig config = drive_config(GetParam());
  const DriveResult r = drive(config, rocks, {{0.0, 0.0}, {10.0, 0.0}}, 1);
  EXPECT_FALSE(r.reached);
  EXPECT_FALSE(r.collided);
  EXPECT_LT(r.duration_s, config.timeout_s);
  EXPECT_EQ(r.text.substr(0, 8), "no path:");
}

TEST_P(ClosedLoopTest, TheSameSeedGivesTheSameDrive) {
  const std::vector<Rock> rocks = {{{4.0, 0.1}, 0.3, 0.3}};
  const DriveResult a = drive(drive_config(GetParam()), rocks, {{0.0, 0.0}, {8.0, 0.0}}, 5);
  const DriveResult b = drive(drive_config(GetParam()), rocks, {{0.0, 0.0}, {8.0, 0.0}}, 5);
  EXPECT_TRUE(a.reached);
  EXPECT_EQ(a.driven_m, b.driven_m);
  EXPECT_EQ(a.duration_s, b.duration_s);
  EXPECT_EQ(a.track.back().y_m, b.track.back().y_m);
}

INSTANTIATE_TEST_SUITE_P(Levels, ClosedLoopTest, testing::Bool(), level_name);

}  // namespace
}  // namespace rover::planning
