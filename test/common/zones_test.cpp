#include "common/core/zones.hpp"

#include <gtest/gtest.h>

#include "test/common/randoms.hpp"

namespace rover {
namespace {

using testing_support::uniform;

Zone square(const std::string& name, double x_m, double y_m, double half_m, bool keep_in = false) {
  return {name,
          keep_in,
          {{x_m - half_m, y_m - half_m},
           {x_m + half_m, y_m - half_m},
           {x_m + half_m, y_m + half_m},
           {x_m - half_m, y_m + half_m}}};
}

std::string forbidding(const std::vector<Zone>& zones, double x_m, double y_m) {
  const Zone* zone = forbidding_zone(zones, {x_m, y_m});
  return zone == nullptr ? "" : zone->name;
}

TEST(Zones, AKeepOutForbidsItsInsideAndAKeepInItsOutside) {
  const std::vector<Zone> zones = {square("crater", 5.0, 0.0, 1.0), square("site", 0.0, 0.0, 20.0, true)};
  EXPECT_EQ(forbidding(zones, 0.0, 0.0), "");
  EXPECT_EQ(forbidding(zones, 5.5, 0.5), "crater");
  EXPECT_EQ(forbidding(zones, 25.0, 0.0), "site");
  EXPECT_EQ(forbidding({}, 25.0, 0.0), "");
}

TEST(Zones, OfSeveralKeepInsOneIsEnough) {
  const std::vector<Zone> zones = {square("west", -5.0, 0.0, 3.0, true), square("east", 5.0, 0.0, 3.0, true)};
  EXPECT_EQ(forbidding(zones, -5.0, 1.0), "");
  EXPECT_EQ(forbidding(zones, 5.0, 1.0), "");
  EXPECT_NE(forbidding(zones, 0.0, 0.0), "");
}

TEST(Zones, AConcavePolygonIsOpenInItsBay) {
  const Zone horseshoe{"horseshoe", false, {{0, 0}, {6, 0}, {6, 6}, {4, 6}, {4, 2}, {2, 2}, {2, 6}, {0, 6}}};
  EXPECT_EQ(forbidding({horseshoe}, 3.0, 4.0), "");
  EXPECT_EQ(forbidding({horseshoe}, 3.0, 1.0), "horseshoe");
  EXPECT_EQ(forbidding({horseshoe}, 1.0, 5.0), "horseshoe");
}

TEST(Zones, TheDepthIsThatOfTheDeepestPartOfTheRectangle) {
  const std::vector<Zone> zones = {square("crater", 5.0, 0.0, 2.0)};
  for (const double x_m : {0.0, 1.9, 2.2, 2.5, 3.0})
    EXPECT_NEAR(forbidden_depth_m(zones, {x_m, 0.0, 0.0}, 0.9, 0.5), std::max(0.0, x_m + 0.9 - 3.0), 1e-9) << x_m;
  EXPECT_GT(forbidden_depth_m(zones, {1.9, 0.0, 0.0}, 1.2, 0.5), 0.05);
  EXPECT_EQ(forbidden_depth_m(zones, {1.9, 0.0, 0.5 * kPi}, 1.2, 0.5), 0.0) << "it lies across";
  const std::vector<Zone> site = {square("site", 0.0, 0.0, 4.0, true)};
  EXPECT_NEAR(forbidden_depth_m(site, {3.5, 0.0, 0.0}, 0.9, 0.5), 0.4, 1e-9);
}

TEST(Zones, ANarrowZoneUnderTheRectangleIsNotMissed) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 100; ++i) {
    const Zone spot = square("spot", uniform(random, -0.7, 0.7), uniform(random, -0.3, 0.3), 0.08);
    EXPECT_GT(forbidden_depth_m({spot}, {}, 0.9, 0.5), 0.0);
  }
}

TEST(Zones, WhatIsNoZoneIsNamed) {
  EXPECT_EQ(zones_problem({square("a", 0.0, 0.0, 1.0), square("b", 0.0, 0.0, 1.0, true)}), "");
  EXPECT_EQ(zones_problem({square("", 0.0, 0.0, 1.0)}), "a zone has no name");
  EXPECT_NE(zones_problem({square("two\nlines", 0.0, 0.0, 1.0)}), "");
  EXPECT_NE(zones_problem({square(std::string(65, 'a'), 0.0, 0.0, 1.0)}), "");
  EXPECT_EQ(zones_problem({square("a", 0.0, 0.0, 1.0), square("a", 0.0, 0.0, 1.0)}), "zone 'a' is there twice");
  EXPECT_EQ(zones_problem({{"line", false, {{0, 0}, {1, 1}}}}), "zone 'line' has fewer than 3 corners");
  EXPECT_EQ(zones_problem({{"flat", false, {{0, 0}, {1, 1}, {2, 2}}}}), "zone 'flat' encloses no area");
  EXPECT_EQ(zones_problem({{"nan", false, {{0, 0}, {1, 0}, {1, kNaN}}}}),
            "zone 'nan' has a corner that is out of range");
  EXPECT_NE(zones_problem(std::vector<Zone>(kMaxZones + 1)), "");
  EXPECT_NE(zones_problem({{"many", false, std::vector<Eigen::Vector2d>(kMaxZoneCorners + 1)}}), "");
}

}  // namespace
}  // namespace rover
