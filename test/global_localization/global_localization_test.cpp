#include "global_localization/global_localization.hpp"

#include <gtest/gtest.h>

#include <random>

#include "test/global_localization/synthetic_terrain.hpp"

namespace rover::global::test {
namespace {

const Pose2 kTruth{95.0, 60.0, 2.1};  // odom is turned against map, its origin is far from the rover
const Eigen::Vector2d kPlace(22.0, -14.0);

// An orbital map with little distortion.
GlobalConfig config_for_test() {
  GlobalConfig config;
  config.map_sigma_m = 0.2;
  config.refinement.half_width_rad = 0.05;
  return config;
}

// Core after a straight drive of this length to kPlace.
GlobalLocalization driven(const Height& height, double cell_m, const Seen& seen = all_seen, double noise_m = 0.0,
                          double distance_m = 16.0) {
  GlobalLocalization core(config_for_test(), orbital_of(height, cell_m, noise_m), kCellM);
  for (double back = distance_m; back >= 0.0; back -= 8.0) {
    const Eigen::Vector2d p = kPlace - Eigen::Vector2d(back, 0.0);
    core.add_elevation(view_of(height, kTruth, p, seen), p);
  }
  return core;
}

Prior prior(const Eigen::Vector2d& off_m, double turn_deg) {
  return {perturbed_transform(kTruth, kPlace, off_m, to_rad(turn_deg)), kPlace, pose_cov()};
}

double error_m(const Correction& c) {
  return (transformed(c.T_map_odom, kPlace) - transformed(kTruth, kPlace)).norm();
}
double error_deg(const Correction& c) {
  return to_deg(std::abs(wrap_angle(c.T_map_odom.yaw_rad - kTruth.yaw_rad)));
}

// Regression of two errors in the published matcher (template offset, yaw applied to the correction): 14.14 m here.
TEST(GlobalLocalization, CorrectTransformStaysUnchanged) {
  for (double cell_m : {0.5, 1.0}) {
    const Correction c = driven(hills, cell_m).correct(prior({0.0, 0.0}, 0.0));
    ASSERT_TRUE(c.accepted) << c.reason;
    EXPECT_LT(error_m(c), 0.1 * cell_m);
    EXPECT_LT(error_deg(c), 0.1);
    EXPECT_GT(c.score, 0.9);
  }
}

// All directions, so that swapped axes cannot pass.
TEST(GlobalLocalization, CorrectsOffsetsInAllDirections) {
  const GlobalLocalization core = driven(hills, 0.5);
  for (const auto& [x, y, turn] : {std::array{9.0, 3.0, 9.0}, std::array{-6.5, 7.3, -9.0}, std::array{0.0, -10.0, 4.0},
                                   std::array{-9.9, 0.2, 0.0}, std::array{3.3, 0.0, -7.7}}) {
    const Correction c = core.correct(prior({x, y}, turn));
    ASSERT_TRUE(c.accepted) << c.reason << " " << x << " " << y << " " << turn;
    EXPECT_LT(error_m(c), 0.05);
    EXPECT_LT(error_deg(c), 0.1);
  }
}

// Parallel ridges: nothing tells how far the rover is along them, nor must the fix pretend it.
TEST(GlobalLocalization, RidgesGiveAFixAcrossThem) {
  const Height ridges = [](double x, double) { return hills(x, 30.5); };
  const GlobalLocalization core = driven(ridges, 0.5, all_seen, 0.05);
  for (const auto& [x, y, turn] : {std::array{5.0, 3.0, 1.0}, std::array{-6.5, -4.0, -2.0}}) {
    const Correction c = core.correct(prior({x, y}, turn));
    EXPECT_EQ(c.axes, 1);
    EXPECT_FALSE(core.featured(c));
    ASSERT_TRUE(c.accepted) << c.reason;
    const Eigen::Vector2d error = transformed(c.T_map_odom, kPlace) - transformed(kTruth, kPlace);
    EXPECT_NEAR(error.x(), 0.0, 0.15);
    EXPECT_NEAR(error.y(), y, 0.3) << "the prior's";
    EXPECT_DOUBLE_EQ(c.T_map_odom.yaw_rad, prior({x, y}, turn).T_map_odom.yaw_rad);
    EXPECT_LT(std::sqrt(c.cov(0, 0)), 1.0);
    EXPECT_GT(std::sqrt(c.cov(1, 1)), 10.0);
  }
}

// The window is wider than max_cells: searched in blocks of 2 x 2 to 4 x 4 cells first.
TEST(GlobalLocalization, FindsALostRoverCoarseToFine) {
  for (int max_cells : {70, 100, 130}) {
    GlobalConfig config = config_for_test();
    config.search.max_cells = max_cells;
    GlobalLocalization core(config, orbital_of(hills, 0.5, 0.05), kCellM);
    for (double back : {16.0, 8.0, 0.0}) {
      const Eigen::Vector2d p = kPlace - Eigen::Vector2d(back, 0.0);
      core.add_elevation(view_of(hills, kTruth, p), p);
    }
    for (const auto& [x, y, turn] : {std::array{40.0, 20.0, 8.0}, std::array{-35.0, 30.0, -9.0}}) {
      Prior lost = prior({x, y}, turn);
      EXPECT_FALSE(is_lost(config.search, lost));
      lost.cov(0, 0) = lost.cov(1, 1) = 400.0;
      EXPECT_TRUE(is_lost(config.search, lost));
      const Correction c = core.correct(lost);
      ASSERT_TRUE(c.accepted) << c.reason << " " << max_cells;
      EXPECT_LT(error_m(c), 0.2);
      EXPECT_LT(error_deg(c), 0.3);
      EXPECT_EQ(c.similar_places, 1);
    }
  }
}

TEST(GlobalLocalization, ErrorFromMapNoiseIsWithinCovariance) {
  for (double cell_m : {0.5, 1.0}) {
    const Correction c = driven(hills, cell_m, all_seen, 0.1).correct(prior({4.0, -5.0}, 6.0));
    ASSERT_TRUE(c.accepted) << c.reason;
    EXPECT_LT(error_m(c), 0.5 * cell_m);
    const Eigen::Vector2d off = transformed(c.T_map_odom, kPlace) - transformed(kTruth, kPlace);
    const Eigen::Vector3d e(off.x(), off.y(), c.T_map_odom.yaw_rad - kTruth.yaw_rad);
    EXPECT_LT(e.dot(c.cov.inverse() * e), 16.3);
    EXPECT_LT(c.cov(0, 0), 0.5);
  }
}

TEST(GlobalLocalization, MapRotationCorrelatesPositionAndYawThroughLeverArm) {
  const Correction c = driven(hills, 0.5, all_seen, 0.0, 48.0).correct(prior({1.0, 1.0}, 1.0));
  ASSERT_TRUE(c.accepted) << c.reason;
  const Eigen::Rotation2Dd R(c.T_map_odom.yaw_rad);
  const Eigen::Vector2d along = R * Eigen::Vector2d::UnitX(), across = R * Eigen::Vector2d::UnitY();
  const Eigen::Matrix2d place = c.cov.topLeftCorner<2, 2>();
  const double arm_m = 24.0, turn_rad2 = c.cov(2, 2);
  EXPECT_NEAR(across.dot(place * across) - along.dot(place * along), arm_m * arm_m * turn_rad2, 0.003);
  EXPECT_NEAR(across.dot(c.cov.block<2, 1>(0, 2)), arm_m * turn_rad2, 1e-4);
}

// Soon after a fix the same terrain is matched again: its distortion is not known better for it.
TEST(GlobalLocalization, TerrainThatTwoFixesShareCountsOnce) {
  const GlobalLocalization core = driven(hills, 0.5, all_seen, 0.0);
  Prior again = prior({1.0, 1.0}, 1.0);
  const Correction first = core.correct(again);
  again.since_fix_m = 1000.0;
  EXPECT_TRUE(core.correct(again).cov.isApprox(first.cov));
  const auto excess = [&](double since_fix_m) {
    again.since_fix_m = since_fix_m;
    const Correction second = core.correct(again);
    EXPECT_TRUE(second.accepted) << second.reason;
    return (second.cov - first.cov).topLeftCorner<2, 2>().trace();
  };
  const double after_2_m = excess(2.0), after_4_m = excess(4.0);
  EXPECT_GT(after_4_m, 0.05);
  EXPECT_GT(after_2_m, 2.0 * after_4_m) << "extent / distance - 1";
  EXPECT_TRUE(std::isfinite(excess(0.0)));
}

// At level EFFICIENT nothing is mapped, so the matched terrain falls behind the body.
TEST(GlobalLocalization, RejectsMatchFarFromBody) {
  GlobalConfig config = config_for_test();
  config.map_sigma_m = 0.6;
  config.acceptance.max_body_sigma_m = 0.8;
  GlobalLocalization core(config, orbital_of(hills, 0.5, 0.0), kCellM);
  core.add_elevation(view_of(hills, kTruth, kPlace, all_seen), kPlace);
  const auto on_by = [&](double distance_m) {
    Prior further = prior({1.0, 1.0}, 1.0);
    further.p_odom_body += Eigen::Vector2d(distance_m, 0.0);
    return core.correct(further);
  };
  const Correction here = on_by(0.0);
  const double place_m2 = here.cov.topLeftCorner<2, 2>().trace() / 2.0;
  const double limit_m = std::sqrt((0.8 * 0.8 - place_m2) / here.cov(2, 2));
  EXPECT_EQ(on_by(0.9 * limit_m).reason, "");
  EXPECT_EQ(on_by(1.1 * limit_m).reason, "too far from the matched terrain");
}

// The published matcher's score collapses with 1 % empty cells.
TEST(GlobalLocalization, ToleratesHolesInLocalMap) {
  const Correction whole = driven(hills, 0.5, all_seen, 0.1).correct(prior({4.0, -5.0}, 6.0));
  ASSERT_TRUE(whole.accepted) << whole.reason;
  for (int percent : {1, 10, 40}) {
    std::mt19937_64 random(8);
    const auto seen = [&](int, int) { return static_cast<int>(random() % 100) >= percent; };
    const Correction c = driven(hills, 0.5, seen, 0.1).correct(prior({4.0, -5.0}, 6.0));
    ASSERT_TRUE(c.accepted) << c.reason << " " << percent;
    EXPECT_NEAR(c.score, whole.score, 0.02) << percent;
    EXPECT_LT(error_m(c), 0.25) << percent;
  }
}

TEST(GlobalLocalization, NarrowStripMatchesLikeWholeMap) {
  const auto strip = [](int, int row) { return row > 60 && row < 140 && row % 23 != 0; };
  const Correction c = driven(hills, 0.5, strip, 0.1, 40.0).correct(prior({-7.0, 5.0}, -6.0));
  ASSERT_TRUE(c.accepted) << c.reason;
  EXPECT_GT(c.score, 0.7);
  EXPECT_LT(error_m(c), 0.25);
}

TEST(GlobalLocalization, RejectsFeaturelessTerrain) {
  const auto slope = [](double x, double y) { return 0.15 * x - 0.05 * y; };
  for (const Height& height : {Height([](double, double) { return 3.0; }), Height(slope)}) {
    const Correction c = driven(height, 0.5, all_seen, 0.1).correct(prior({2.0, 1.0}, 1.0));
    EXPECT_FALSE(c.accepted);
    EXPECT_EQ(c.reason, "not enough relief");
  }
}

// Dunes with a period of 9 m in both directions.
TEST(GlobalLocalization, RejectsAmbiguousPeriodicTerrain) {
  const auto dunes = [](double x, double y) { return 0.6 * std::sin(x * 2 * kPi / 9.0) * std::cos(y * 2 * kPi / 9.0); };
  const Correction c = driven(dunes, 0.5, all_seen, 0.1).correct(prior({2.0, 1.0}, 1.0));
  EXPECT_FALSE(c.accepted);
  EXPECT_EQ(c.reason, "ambiguous: other places are almost as similar");
  EXPECT_GE(c.similar_places, 2);
}

TEST(GlobalLocalization, RejectsTruePoseOutsideSearchWindow) {
  const GlobalLocalization core = driven(hills, 0.5, all_seen, 0.1);
  for (const auto& [x, y] : {std::array{25.0, 0.0}, std::array{-20.0, 20.0}, std::array{0.0, -26.0}})
    EXPECT_FALSE(core.correct(prior({x, y}, 2.0)).accepted) << x << " " << y;
  EXPECT_FALSE(core.correct(prior({1.0, 1.0}, 25.0)).accepted);
}

// The search ends at the window's border, the refinement crosses it.
TEST(GlobalLocalization, RejectsMatchAtSearchWindowBorder) {
  EXPECT_EQ(driven(hills, 0.5).correct(prior({1.0, 1.0}, 13.5)).reason,
            "best match at the border of the search window");
}

// Inside the window in x, y and yaw, but too far in combination.
TEST(GlobalLocalization, RejectsLargeNormalisedInnovation) {
  EXPECT_EQ(driven(hills, 0.5).correct(prior({11.5, -11.5}, 10.0)).reason,
            "innovation larger than the pose's covariance allows");
}

// Same shape at a third of the height.
TEST(GlobalLocalization, RejectsHeightResidualAboveLimit) {
  GlobalLocalization core(config_for_test(), orbital_of([](double x, double y) { return 0.3 * hills(x, y); }, 0.5),
                          kCellM);
  for (double back : {16.0, 8.0, 0.0}) {
    const Eigen::Vector2d p = kPlace - Eigen::Vector2d(back, 0.0);
    core.add_elevation(view_of(hills, kTruth, p), p);
  }
  EXPECT_EQ(core.correct(prior({1.0, 1.0}, 1.0)).reason, "best match not similar enough");
}

TEST(GlobalLocalization, RejectsMapOfAnotherArea) {
  const auto elsewhere = [](double x, double y) { return hills(x + 500.0, y - 300.0); };
  GlobalLocalization core(config_for_test(), orbital_of(elsewhere, 0.5, 0.1), kCellM);
  for (double back : {16.0, 8.0, 0.0}) {
    const Eigen::Vector2d p = kPlace - Eigen::Vector2d(back, 0.0);
    core.add_elevation(view_of(hills, kTruth, p), p);
  }
  const Correction c = core.correct(prior({1.0, 1.0}, 1.0));
  EXPECT_FALSE(c.accepted);
  EXPECT_FALSE(c.reason.empty());
}

TEST(GlobalLocalization, RejectsPoseOutsideOrbitalMap) {
  const GlobalLocalization core = driven(hills, 0.5);
  Prior off = prior({0.0, 0.0}, 0.0);
  for (double far_m : {-100.0, 400.0, 1e9, -1e9}) {
    off.T_map_odom.x_m = far_m;
    const Correction c = core.correct(off);
    EXPECT_FALSE(c.accepted);
    EXPECT_EQ(c.reason, "no similar terrain on the orbital map");
  }
}

TEST(GlobalLocalization, IgnoresOrbitalCellsWithoutData) {
  HeightGrid orbital = orbital_of(hills, 0.5, 0.05);
  std::mt19937_64 random(4);
  for (int k = 0; k < 60; ++k) {  // voids of 1.5 m
    const int column = static_cast<int>(random() % 316), row = static_cast<int>(random() % 316);
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) {
        orbital.z_m[orbital.lattice.index(column + i, row + j)] = -9999.0f;
        orbital.weight[orbital.lattice.index(column + i, row + j)] = 0.0f;
      }
  }
  GlobalLocalization core(config_for_test(), orbital, kCellM);
  for (double back : {16.0, 8.0, 0.0}) {
    const Eigen::Vector2d p = kPlace - Eigen::Vector2d(back, 0.0);
    core.add_elevation(view_of(hills, kTruth, p), p);
  }
  const Correction c = core.correct(prior({5.0, 5.0}, -5.0));
  ASSERT_TRUE(c.accepted) << c.reason;
  EXPECT_LT(error_m(c), 0.25);
}

TEST(GlobalLocalization, RejectsEmptyMapAndInvalidPose) {
  GlobalLocalization core(config_for_test(), orbital_of(hills, 1.0), kCellM);
  EXPECT_EQ(core.correct(prior({0.0, 0.0}, 0.0)).reason, "local map too small");
  core.add_elevation(view_of(hills, kTruth, kPlace, [](int, int) { return false; }), kPlace);
  EXPECT_EQ(core.correct(prior({0.0, 0.0}, 0.0)).reason, "local map too small");
  Prior broken = prior({0.0, 0.0}, 0.0);
  broken.cov(0, 0) = kNaN;
  EXPECT_EQ(core.correct(broken).reason, "invalid pose");
  broken = prior({0.0, 0.0}, 0.0);
  broken.T_map_odom.yaw_rad = kInfinity;
  EXPECT_EQ(core.correct(broken).reason, "invalid pose");
}

TEST(GlobalLocalization, IsDeterministicBitForBit) {
  const Correction a = driven(hills, 0.5, all_seen, 0.1).correct(prior({4.0, -5.0}, 6.0));
  const Correction b = driven(hills, 0.5, all_seen, 0.1).correct(prior({4.0, -5.0}, 6.0));
  EXPECT_EQ(a.T_map_odom.x_m, b.T_map_odom.x_m);
  EXPECT_EQ(a.T_map_odom.yaw_rad, b.T_map_odom.yaw_rad);
  EXPECT_EQ(a.cov, b.cov);
}

GlobalLocalization driven_with_picture(const Height& height, const Height& from_orbit, const Height& from_rover,
                                       bool seen = true) {
  GlobalLocalization core(config_for_test(), orbital_of(height, 1.0), kCellM, OrbitalMap(orbital_of(from_orbit, 0.25)));
  for (double back = 16.0; back >= 0.0; back -= 8.0) {
    const Eigen::Vector2d p = kPlace - Eigen::Vector2d(back, 0.0);
    ElevationView view = view_of(height, kTruth, p);
    if (seen) view.brightness = view_of(from_rover, kTruth, p).z_m;
    core.add_elevation(view, p);
  }
  return core;
}

// The orbiter's sun stands opposite, with another contrast.
TEST(PictureOfThePlain, LocatesTheRover) {
  const GlobalLocalization core = driven_with_picture(
      level, [](double x, double y) { return 250.0 - 1.5 * marks(x, y); }, marks);
  for (const auto& [x, y, turn] :
       {std::array{9.0, 3.0, 9.0}, std::array{-6.5, 7.3, -9.0}, std::array{0.0, -10.0, 4.0}}) {
    const Correction c = core.correct(prior({x, y}, turn));
    ASSERT_TRUE(c.accepted) << c.reason;
    EXPECT_EQ(c.layer, Layer::kPicture);
    EXPECT_LT(error_m(c), 0.1);
    EXPECT_LT(error_deg(c), 0.3);
    EXPECT_GT(std::sqrt(c.cov(0, 0)), 0.1) << "the distortion of the picture";
  }
}

TEST(PictureOfThePlain, OfAnotherPlaceIsRejected) {
  const GlobalLocalization core = driven_with_picture(
      level, [](double x, double y) { return marks(x + 60.0, y - 35.0); }, marks);
  for (const double turn_deg : {-6.0, 0.0, 6.0}) {
    const Correction c = core.correct(prior({2.0, 3.0}, turn_deg));
    EXPECT_FALSE(c.accepted);
    EXPECT_FALSE(core.correct_by_picture(prior({2.0, 3.0}, turn_deg)).reason.empty());
  }
}

TEST(PictureOfThePlain, RepeatedRipplesAreAmbiguous) {
  const Height ripples = [](double x, double y) { return 50.0 + 20.0 * std::sin(1.1 * x) * std::cos(1.1 * y); };
  const Correction c = driven_with_picture(level, ripples, ripples).correct_by_picture(prior({2.0, 1.0}, 1.0));
  EXPECT_FALSE(c.accepted);
  EXPECT_GT(c.similar_places, 1);
}

TEST(PictureOfThePlain, IsNotAskedWhereReliefLocatesTheRoverOrItIsLost) {
  const Correction by_relief = driven_with_picture(hills, marks, marks).correct(prior({4.0, 3.0}, 2.0));
  EXPECT_TRUE(by_relief.accepted);
  EXPECT_EQ(by_relief.layer, Layer::kHeight);
  Prior lost = prior({4.0, 3.0}, 2.0);
  lost.cov(0, 0) = lost.cov(1, 1) = 400.0;
  EXPECT_EQ(driven_with_picture(level, marks, marks).correct(lost).reason, "not enough relief");
}

TEST(PictureOfThePlain, WithoutBrightnessNothingIsMatched) {
  const GlobalLocalization core = driven_with_picture(level, marks, marks, false);
  EXPECT_EQ(core.correct(prior({1.0, 1.0}, 1.0)).reason, "not enough relief");
  EXPECT_EQ(core.correct_by_picture(prior({1.0, 1.0}, 1.0)).reason, "local picture too small");
}

}  // namespace
}  // namespace rover::global::test
