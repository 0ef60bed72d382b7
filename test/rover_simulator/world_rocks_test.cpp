#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "world_fixture.hpp"

namespace rover {
namespace {

RockConfig rocks_of(double k) {
  RockConfig config;
  config.k = k;
  return config;
}

// Published rocks per hectare above 0.4 m for these k.
TEST(RockLaw, MatchesPublishedDensities) {
  const std::pair<double, double> known[] = {{0.02, 26},  {0.05, 315},  {0.07, 575},
                                             {0.10, 983}, {0.15, 1665}, {0.20, 2321}};
  for (const auto& [k, per_hectare] : known)
    EXPECT_NEAR(1e4 * rock_density_above(rocks_of(k), 0.4), per_hectare, 0.03 * per_hectare + 1.0) << k;
}

// Areas of the drawn rocks against F(D) = k exp(-q D) without the rocks that are larger than the largest drawn; within
// four deviations of a Poisson count.
TEST(RockField, CoveredAreaMatchesSizeFrequencyLaw) {
  for (double k : {0.03, 0.08, 0.19}) {
    const RockConfig config = rocks_of(k);
    const RockField field(config, 300, 300, {}, 11);
    const double q = 1.79 + 0.152 / k;
    const auto law = [&](double d) { return k * (std::exp(-q * d) - std::exp(-q * config.max_diameter_m)); };
    for (double above : {0.08, 0.2, 0.4, 0.6}) {
      double area = 0.0, squares = 0.0;
      for (const Rock& rock : field.all())
        if (rock.diameter_m >= above) {
          const double own = M_PI * rock.diameter_m * rock.diameter_m / 4.0;
          area += own;
          squares += own * own;
        }
      EXPECT_NEAR(area / 9e4, law(above), 0.02 * law(above) + 4.0 * std::sqrt(squares) / 9e4) << k << " " << above;
    }
  }
}

TEST(RockZone, ContainsPointsWithinHalfWidthOfLine) {
  const RockZone zone{0.1, 5.0, {10, 30, 30}, {10, 10, 40}};
  EXPECT_TRUE(zone.contains(20, 14.9));
  EXPECT_TRUE(zone.contains(34.9, 30));
  EXPECT_TRUE(zone.contains(6.0, 8.0));
  EXPECT_FALSE(zone.contains(20, 15.1));
  EXPECT_FALSE(zone.contains(4.9, 10));
  EXPECT_FALSE(zone.contains(30, 45.1));
  const RockZone circle{0.1, 5.0, {10}, {10}};
  EXPECT_TRUE(circle.contains(13, 14));
  EXPECT_FALSE(circle.contains(13.1, 14));
}

// Within the zone the rocks are those of a field of its abundance, outside those of the field without zones.
TEST(RockField, ZoneHasItsOwnRockAbundance) {
  RockConfig config = rocks_of(0.05);
  config.zones = {{0.12, 20.0, {30, 120}, {60, 60}}, {0.0, 15.0, {120}, {60}}, {0.2, 10.0, {100}, {150}}};
  const RockField zoned(config, 200, 200, {}, 9);
  const std::vector<double> abundances = {0.05, 0.12, 0.0, 0.2};
  const auto zone_of = [&](const Rock& rock) {
    const double x = std::floor(rock.x_m) + 0.5, y = std::floor(rock.y_m) + 0.5;
    for (size_t i = 0; i < config.zones.size(); ++i)
      if (config.zones[i].contains(x, y)) return i + 1;
    return size_t{0};
  };
  std::vector<std::vector<Rock>> found(abundances.size()), expected(abundances.size());
  for (const Rock& rock : zoned.all()) found[zone_of(rock)].push_back(rock);
  for (size_t i = 0; i < abundances.size(); ++i) {
    const RockField field(rocks_of(abundances[i]), 200, 200, {}, 9);
    for (const Rock& rock : field.all())
      if (zone_of(rock) == i) expected[i].push_back(rock);
    ASSERT_EQ(found[i].size(), expected[i].size()) << i;
    for (size_t k = 0; k < found[i].size(); ++k) {
      EXPECT_EQ(found[i][k].x_m, expected[i][k].x_m);
      EXPECT_EQ(found[i][k].diameter_m, expected[i][k].diameter_m);
    }
  }
  EXPECT_GT(found[1].size(), 1000u);
  EXPECT_TRUE(found[2].empty());
}

TEST(RockField, HeightRatiosAreWithinLimits) {
  const RockField field(rocks_of(0.1), 100, 100, {}, 3);
  double mean = 0.0;
  for (const Rock& rock : field.all()) {
    const double ratio = rock.height_m / rock.diameter_m;
    ASSERT_GE(ratio, 0.3);
    ASSERT_LE(ratio, 0.7);
    mean += ratio / static_cast<double>(field.all().size());
  }
  EXPECT_NEAR(mean, 0.5, 0.01);
}

TEST(RockField, EachRockReachesItsHeight) {
  const RockField field(rocks_of(0.05), 60, 60, {}, 4);
  int alone = 0;
  for (const Rock& rock : field.all()) {
    const RockField::Hit summit = field.at(rock.x_m, rock.y_m);
    ASSERT_GE(summit.height_m, 0.999 * rock.height_m);
    if (summit.rock_id != rock.id) continue;  // a taller one covers it
    ++alone;
    EXPECT_NEAR(summit.height_m, rock.height_m, 1e-4);
    double highest = 0.0;
    for (double dx = -1.0; dx <= 1.0; dx += 0.05)
      for (double dy = -1.0; dy <= 1.0; dy += 0.05) {
        const RockField::Hit hit = field.at(rock.x_m + dx * rock.diameter_m, rock.y_m + dy * rock.diameter_m);
        if (hit.rock_id == rock.id) highest = std::max(highest, hit.height_m);
      }
    EXPECT_LE(highest, rock.height_m * 1.0001);
  }
  EXPECT_GT(alone, 1000);
}

// Height change over 2 mm is bounded by the steepest flank.
TEST(RockField, IsContinuousWithSteepFlanks) {
  const RockField field(rocks_of(0.1), 40, 40, {}, 9);
  double steepest = 0.0;
  for (double y : {10.03, 14.2, 21.7, 33.3}) {
    double before = field.at(1.0, y).height_m;
    for (double x = 1.002; x < 39.0; x += 0.002) {
      const double height = field.at(x, y).height_m;
      steepest = std::max(steepest, std::abs(height - before) / 0.002);
      before = height;
    }
  }
  EXPECT_GT(steepest, 1.7);  // 60 degrees
  EXPECT_LT(steepest, 9.0);  // 84 degrees
}

TEST(RockField, IsPureFunctionOfSeedAndPosition) {
  const RockConfig config = rocks_of(0.1);
  const RockField small(config, 50, 50, {}, 7), large(config, 90, 80, {}, 7), other(config, 50, 50, {}, 8);
  const std::vector<Rock> a = small.in(10, 10, 40, 40), b = large.in(10, 10, 40, 40), c = other.in(10, 10, 40, 40);
  ASSERT_EQ(a.size(), b.size());
  ASSERT_GT(a.size(), 500u);
  for (const Rock& rock : a)
    EXPECT_TRUE(std::any_of(b.begin(), b.end(), [&](const Rock& twin) {
      return twin.x_m == rock.x_m && twin.y_m == rock.y_m && twin.diameter_m == rock.diameter_m &&
             twin.height_m == rock.height_m;
    }));
  EXPECT_NE(a.front().x_m, c.front().x_m);
}

TEST(RockField, BoxQueryEqualsBruteForce) {
  const RockField field(rocks_of(0.15), 60, 60, {}, 5);
  const std::vector<Rock> found = field.in(12.3, 20.1, 31.7, 22.9);
  std::vector<int> expected;
  for (const Rock& rock : field.all())
    if (rock.x_m >= 12.3 && rock.x_m <= 31.7 && rock.y_m >= 20.1 && rock.y_m <= 22.9) expected.push_back(rock.id);
  ASSERT_EQ(found.size(), expected.size());
  for (size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].id, expected[i]);
}

TEST(RockField, KeepsOnlyKeepClearCirclesFree) {
  const RockConfig config = rocks_of(0.19);
  const std::vector<KeepClear> circles = {{20, 20, 1.5, 0.12}, {40, 30, 3.0, 0.12}};
  const RockField free(config, 60, 60, {}, 2), kept(config, 60, 60, circles, 2);
  for (const KeepClear& circle : circles)
    for (double r = 0.0; r <= circle.radius_m; r += 0.02)
      for (double angle = 0.0; angle < 2.0 * M_PI; angle += 0.01)
        ASSERT_LT(kept.at(circle.x_m + r * std::cos(angle), circle.y_m + r * std::sin(angle)).height_m, 0.12);
  EXPECT_LT(kept.all().size(), free.all().size());
  EXPECT_GT(kept.all().size(), free.all().size() - 60);
}

TEST(RockField, IsEmptyForZeroAbundance) {
  const RockField field(rocks_of(0.0), 30, 30, {}, 1);
  EXPECT_TRUE(field.all().empty());
  EXPECT_EQ(field.at(10, 10).rock_id, -1);
}

}  // namespace
}  // namespace rover
