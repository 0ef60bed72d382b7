// Levels along a straight line with known difficulty.
#include "tools/orbital_planner/levels.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "map_fixture.hpp"

namespace rover::orbital {
namespace {

constexpr double kStepM = 1.0;

Line straight(int points) {
  Line line;
  for (int i = 0; i < points; ++i) line.emplace_back(i * kStepM, 0.0);
  return line;
}

// One letter for each point: E or F.
std::string levels_of(int points, const std::function<double(double)>& difficulty, LevelConfig config = {}) {
  std::vector<double> along;
  for (int i = 0; i < points; ++i) along.push_back(difficulty(i * kStepM));
  std::string text;
  for (Level level : levels_along(straight(points), along, config)) text += level == Level::kFull ? 'F' : 'E';
  return text;
}

std::string run(size_t efficient, size_t full, size_t efficient_again) {
  return std::string(efficient, 'E') + std::string(full, 'F') + std::string(efficient_again, 'E');
}

const auto kEasy = [](double) { return 0.2; };
const auto kHard = [](double) { return 0.7; };

std::function<double(double)> hard_between(double from_m, double to_m) {
  return [=](double length_m) { return length_m >= from_m && length_m <= to_m ? 0.7 : 0.2; };
}

TEST(Levels, EasyTerrainIsEfficientHardTerrainFull) {
  EXPECT_EQ(levels_of(50, kEasy), std::string(50, 'E'));
  EXPECT_EQ(levels_of(50, kHard), std::string(50, 'F'));
}

TEST(Levels, FullBeginsAheadOfTheHardGround) {
  // Hard from the point at 60 m to the one at 100 m, easy from 101 m on; 4 m ahead.
  EXPECT_EQ(levels_of(201, hard_between(60, 100)), run(56, 45, 100));
}

TEST(Levels, HysteresisKeepsLevelBetweenThresholds) {
  const auto ramp = [](double length_m) { return length_m < 100 ? length_m / 100.0 : 2.0 - length_m / 100.0; };
  LevelConfig config;
  config.lead_distance_m = 0.0;
  // Up beyond 0.55 at 56 m; down again below 0.40, at 160 m, and not at 145 m already.
  EXPECT_EQ(levels_of(201, ramp, config), run(56, 104, 41));
  config.efficient_below = config.full_above;
  EXPECT_EQ(levels_of(201, ramp, config), run(56, 89, 56));
}

TEST(Levels, DifficultyNearThresholdDoesNotOscillate) {
  const auto about = [](double length_m) { return 0.55 + 0.1 * std::sin(length_m); };
  LevelConfig config;
  config.lead_distance_m = config.min_segment_length_m = 0.0;
  const std::string levels = levels_of(200, about, config);
  int switches = 0;
  for (size_t i = 1; i < levels.size(); ++i) switches += levels[i] != levels[i - 1];
  EXPECT_EQ(switches, 1);
}

TEST(Levels, ShortHardTerrainGetsMinimumSegmentLength) {
  const std::string levels = levels_of(201, hard_between(100, 102));
  EXPECT_EQ(std::count(levels.begin(), levels.end(), 'F'), 21);
  for (size_t i = 98; i <= 102; ++i) EXPECT_EQ(levels[i], 'F');
}

TEST(Levels, AShortEasyGapBecomesFull) {
  const auto two = [](double length_m) {
    return (length_m >= 50 && length_m <= 80) || (length_m >= 95 && length_m <= 120) ? 0.7 : 0.2;
  };
  EXPECT_EQ(levels_of(201, two), run(46, 75, 80));
}

TEST(Levels, ShortEndsBecomeFull) {
  EXPECT_EQ(levels_of(100, hard_between(10, 40)), run(0, 41, 59));
  EXPECT_EQ(levels_of(100, hard_between(50, 90)), run(46, 54, 0));
}

TEST(Levels, AShortPathIsOfOneLevel) {
  EXPECT_EQ(levels_of(6, kEasy), "EEEEEE");
  EXPECT_EQ(levels_of(6, hard_between(3, 3)), "FFFFFF");
}

TEST(Difficulty, IsMeanOverCorridorAndArcLength) {
  // Level ground, then a slope of 9 deg from x = 30 m on.
  const double g = std::tan(to_rad(9.0));
  const TerrainLayers layers =
      analyse(map_of(80, 20, 1.0, [g](double x, double) { return std::max(0.0, g * (x - 30.0)); }), {});
  Line line;
  for (int i = 0; i < 60; ++i) line.emplace_back(10.0 + i, 10.0);
  const std::vector<double> difficulty = difficulty_along(line, layers, {});
  EXPECT_NEAR(difficulty[5], 0.0, 1e-3);
  EXPECT_NEAR(difficulty[40], 9.0 / 15.0, 1e-3);
  EXPECT_GT(difficulty[20], 0.15);
  EXPECT_LT(difficulty[20], 0.45);
}

TEST(Difficulty, UnknownGroundIsHard) {
  const TerrainLayers layers = analyse(map_of(30, 30, 1.0, [](double, double) { return kVoid; }), {});
  EXPECT_EQ(difficulty_along({{10, 10}, {20, 20}}, layers, {})[0], 1.0);
}

}  // namespace
}  // namespace rover::orbital
