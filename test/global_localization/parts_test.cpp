// Unit tests of plane fit, local mosaic, expected covariance, search, refinement and schedule.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <random>

#include "global_localization/attempt_schedule.hpp"
#include "global_localization/correlation_search.hpp"
#include "global_localization/edge_field.hpp"
#include "global_localization/refinement.hpp"
#include "global_localization/terrain_template.hpp"
#include "test/global_localization/synthetic_terrain.hpp"

namespace rover::global::test {
namespace {

HeightGrid grid_of(const Height& height, int cells, double cell_m, const Seen& seen = all_seen) {
  HeightGrid grid;
  grid.lattice = {cells, cells, cell_m, -3.0, 7.0};
  for (int row = 0; row < cells; ++row)
    for (int column = 0; column < cells; ++column) {
      const bool known = seen(column, row);
      const double z = known ? height(grid.lattice.center_x_m(column), grid.lattice.center_y_m(row)) : 1e6;
      grid.z_m.push_back(static_cast<float>(z));
      grid.weight.push_back(known ? 1.0f : 0.0f);
    }
  return grid;
}

TEST(PlaneField, SlopeIsUnbiasedBesideHoles) {
  std::mt19937_64 random(3);
  const auto seen = [&](int column, int row) { return column < 22 + row / 4 && random() % 100 >= 20; };
  const PlaneField field =
      plane_field(grid_of([](double x, double y) { return 0.2 * x - 0.1 * y; }, 40, 0.5, seen), {2.0, 0.5});
  int known = 0;
  for (size_t i = 0; i < field.known.size(); ++i) {
    if (field.known[i] == 0) continue;
    ++known;
    EXPECT_NEAR(field.gx[i], 0.2, 1e-4);
    EXPECT_NEAR(field.gy[i], -0.1, 1e-4);
  }
  EXPECT_GT(known, 600);
  EXPECT_LT(known, 1300);
}

TEST(PlaneField, UnobservedCellsHaveNoGradient) {
  const PlaneField field = plane_field(
      grid_of([](double, double) { return 1.0; }, 30, 0.5, [](int column, int) { return column < 8; }), {2.0, 0.5});
  for (int row = 0; row < 30; ++row) {
    EXPECT_EQ(field.known[field.lattice.index(20, row)], 0);
    EXPECT_EQ(field.gx[field.lattice.index(20, row)], 0.0f);
  }
  EXPECT_EQ(field.known[field.lattice.index(4, 15)], 1);
}

// The Gaussian damps a wave's gradient by exp(-k^2 sigma^2 / 2).
TEST(PlaneField, EqualsDerivativeOfGaussian) {
  const double k = 2.0 * kPi / 8.0, sigma_m = 1.0;
  const HeightGrid grid = grid_of([&](double x, double) { return std::sin(k * x); }, 60, 0.5);
  const PlaneField field = plane_field(grid, {sigma_m / 0.5, 0.5});
  for (int column = 20; column < 40; ++column) {
    const double x = grid.lattice.center_x_m(column);
    EXPECT_NEAR(field.gx[grid.lattice.index(column, 30)],
                k * std::cos(k * x) * std::exp(-0.5 * k * k * sigma_m * sigma_m), 0.01);
  }
}

// The same edges under a sun on the other side, and three times the contrast; on ground turned by 30 deg, edges turned
// by 60 deg.
TEST(EdgeField, IsTheSameUnderLightFromTheOppositeSide) {
  const PlaneConfig filter{.sigma_cells = 1.0, .min_support = 0.5};
  const auto edges = [&](const Height& brightness) {
    return edge_field(plane_field(grid_of(brightness, 60, 0.5), filter));
  };
  const PlaneField lit = edges(hills);
  const PlaneField opposite = edges([](double x, double y) { return 100.0 - 3.0 * hills(x, y); });
  double strongest = 0.0;
  for (size_t i = 0; i < lit.known.size(); ++i) {
    EXPECT_NEAR(lit.gx[i], opposite.gx[i], 2e-3);
    EXPECT_NEAR(lit.gy[i], opposite.gy[i], 2e-3);
    strongest = std::max(strongest, std::hypot(static_cast<double>(lit.gx[i]), static_cast<double>(lit.gy[i])));
  }
  EXPECT_GT(strongest, 0.8);
  EXPECT_LE(strongest, 1.0);
  const PlaneField ramp = edges([](double x, double y) {
    const Eigen::Vector2d p = Eigen::Rotation2Dd(to_rad(30.0)).inverse() * Eigen::Vector2d(x, y);
    return p.x();
  });
  const size_t middle = ramp.lattice.index(30, 30);
  EXPECT_NEAR(std::atan2(ramp.gy[middle], ramp.gx[middle]), to_rad(60.0), 1e-3);
  EXPECT_NEAR(turn_of(Layer::kPicture, to_rad(30.0)).angle(), to_rad(60.0), 1e-9);
  EXPECT_NEAR(turn_of(Layer::kHeight, to_rad(30.0)).angle(), to_rad(30.0), 1e-9);
}

TEST(EdgeField, UniformGroundHasNone) {
  const PlaneField flat = edge_field(plane_field(grid_of([](double, double) { return 7.0; }, 30, 0.5), {1.0, 0.5}));
  for (size_t i = 0; i < flat.gx.size(); ++i) EXPECT_EQ(std::hypot(flat.gx[i], flat.gy[i]), 0.0f);
}

void insert(LocalMosaic& mosaic, const ElevationView& view, const Eigen::Vector2d& p_odom_body) {
  mosaic.add(view.lattice, view.z_m, view.sigma_m, p_odom_body, 0.3);
}

TEST(LocalMosaic, KeepsCellsThatLeftTheInputMapUntilOutOfRange) {
  LocalMosaic mosaic(40.0, kCellM);
  const Pose2 T{80.0, 80.0, 0.0};
  for (double x = 0.0; x <= 12.0; x += 4.0) insert(mosaic, view_of(hills, T, {x, 0.0}), {x, 0.0});
  const HeightGrid near = mosaic.resampled(0.5);
  double area_m2 = 0.0;
  for (float w : near.weight) area_m2 += 0.25 * w;
  EXPECT_NEAR(area_m2, 30.0 * 20.0, 1.0);  // x from -8 (mosaic border) to 22
  insert(mosaic, view_of(hills, T, {200.0, 0.0}, [](int, int) { return false; }), {200.0, 0.0});
  for (float w : mosaic.resampled(0.5).weight) EXPECT_EQ(w, 0.0f);
}

TEST(LocalMosaic, DownsamplesByBoxAverage) {
  LocalMosaic mosaic(20.0, kCellM);
  // A checkerboard of 0.1 m cells averages to 0 at 1 m; every second row is unobserved.
  const Height checks = [](double x, double y) {
    return (std::lround(std::floor(x / kCellM + 1e-6) + std::floor(y / kCellM + 1e-6)) % 2 == 0) ? 0.5 : -0.5;
  };
  insert(mosaic, view_of(checks, {80.0, 80.0, 0.0}, {0.0, 0.0}, [](int, int row) { return row % 2 == 0; }), {0.0, 0.0});
  const HeightGrid grid = mosaic.resampled(1.0);
  int seen = 0;
  for (size_t i = 0; i < grid.weight.size(); ++i) {
    if (grid.weight[i] < 0.4f) continue;
    ++seen;
    EXPECT_NEAR(grid.weight[i], 0.5, 0.02);
    EXPECT_NEAR(grid.z_m[i], 5.0, 0.02);
  }
  EXPECT_GT(seen, 300);
}

TEST(LocalMosaic, IgnoresCellsWithLargeOrNanSigma) {
  LocalMosaic mosaic(20.0, kCellM);
  ElevationView view = view_of(hills, {80.0, 80.0, 0.0}, {0.0, 0.0});
  std::fill(view.sigma_m.begin(), view.sigma_m.begin() + 20'000, 1.0f);
  std::fill(view.sigma_m.begin() + 20'000, view.sigma_m.end(), static_cast<float>(kNaN));
  insert(mosaic, view, {0.0, 0.0});
  for (float w : mosaic.resampled(0.5).weight) EXPECT_EQ(w, 0.0f);
}

// Information (inverse variance) about the least observable shift, and about yaw.
struct Relief {
  double shift_m2;
  double turn_m4;
};

Relief relief_of(const TerrainTemplate& terrain) {
  const Eigen::Matrix3d covariance = expected_covariance(terrain);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> shift(covariance.topLeftCorner<2, 2>());
  return {1.0 / shift.eigenvalues()(1), 1.0 / covariance(2, 2)};
}

Relief relief_of(const Height& height) {
  return relief_of(terrain_template(grid_of(height, 60, 0.5), {1.5, 0.5}));
}

TEST(Relief, FlatSlopingAndFurrowedTerrainIsUnobservable) {
  EXPECT_LT(relief_of([](double, double) { return 2.0; }).shift_m2, 1e-6);
  EXPECT_LT(relief_of([](double x, double y) { return 0.2 * x + 0.1 * y; }).shift_m2, 1e-6);
  const Relief furrows = relief_of([](double x, double) { return std::sin(x); });
  EXPECT_LT(furrows.shift_m2, 1e-3);  // shifts along y leave it as it is
  EXPECT_GT(furrows.turn_m4, 1000.0);
  EXPECT_LT(relief_of(TerrainTemplate{}).shift_m2, 1e-6);
}

TEST(Relief, YawIsUnobservableOnRoundHill) {
  const Relief hill = relief_of(
      [](double x, double y) { return 2.0 * std::exp(-0.02 * (std::pow(x - 12.0, 2) + std::pow(y - 22.0, 2))); });
  EXPECT_LT(hill.turn_m4, 0.1);
}

// For z = a sin(kx) sin(ky) the mean square height change per metre of shift is a^2 k^2 / 4.
TEST(Relief, InformationEqualsMeanSquareHeightChangePerMetre) {
  const double a = 0.5, k = 2.0 * kPi / 10.0, damping = std::exp(-k * k * 0.75 * 0.75);
  const double mean = a * a * k * k / 4.0 * damping * damping;  // of a wave along the diagonal
  const TerrainTemplate terrain = terrain_template(
      grid_of([&](double x, double y) { return a * std::sin(k * x) * std::sin(k * y); }, 80, 0.5), {1.5, 0.5});
  EXPECT_NEAR(relief_of(terrain).shift_m2 / terrain.area_m2(), mean, 0.15 * mean);
}

// Samples on a rectangle about the centre, 0.5 m apart.
TerrainTemplate rectangle(double length_m, double width_m) {
  TerrainTemplate terrain;
  for (double x = -0.5 * length_m; x <= 0.5 * length_m; x += 0.5)
    for (double y = -0.5 * width_m; y <= 0.5 * width_m; y += 0.5) terrain.samples.push_back({{x, y}, 0.0, {0.0, 0.0}});
  return terrain;
}

// A small piece moves and turns with the field: half the difference of its two slopes, each sigma / length. A long one
// takes the mean.
TEST(DistortionCovariance, IsThatOfTheBestRigidFit) {
  constexpr double kSigmaM = 0.3, kLengthM = 20.0;
  const Eigen::Matrix3d small = distortion_covariance(rectangle(2.0, 2.0), kSigmaM, kLengthM);
  EXPECT_NEAR(std::sqrt(small(0, 0)), kSigmaM, 0.005);
  EXPECT_NEAR(std::sqrt(small(2, 2)), kSigmaM / kLengthM / std::sqrt(2.0), 1e-4);
  EXPECT_NEAR(small(0, 1), 0.0, 1e-6);
  const Eigen::Matrix3d strip = distortion_covariance(rectangle(2.0, 0.0), kSigmaM, kLengthM);
  EXPECT_NEAR(std::sqrt(strip(2, 2)), kSigmaM / kLengthM, 5e-4) << "by the field across it alone";
  constexpr double kLongM = 2000.0;
  const Eigen::Matrix3d road = distortion_covariance(rectangle(kLongM, 0.5), kSigmaM, kLengthM);
  EXPECT_NEAR(road(0, 0), kSigmaM * kSigmaM * std::sqrt(2.0 * kPi) * kLengthM / kLongM, 2e-4);
  EXPECT_NEAR(road(2, 2), 12.0 / (kLongM * kLongM) * road(1, 1), 0.05 * road(2, 2)) << "a line's moment of inertia";
  const Eigen::Matrix3d path = distortion_covariance(rectangle(60.0, 8.0), kSigmaM, kLengthM);
  EXPECT_NEAR(to_deg(std::sqrt(path(2, 2))), 0.5, 0.1);
}

TEST(CorrelationSearch, ComparesOnlyCellsValidInBothMaps) {
  const auto holed = [](int column, int row) { return (column / 9 + row / 9) % 3 != 0; };
  const HeightGrid local = grid_of(hills, 50, 0.5);
  const TerrainTemplate terrain = terrain_template(local, {1.5, 0.5});
  const auto peak_on = [&](const Seen& seen) {
    HeightGrid map;
    map.lattice = {130, 130, 0.5, -23.0, -13.0};
    for (int row = 0; row < 130; ++row)
      for (int column = 0; column < 130; ++column) {
        map.z_m.push_back(static_cast<float>(hills(map.lattice.center_x_m(column), map.lattice.center_y_m(row))));
        map.weight.push_back(seen(column, row) ? 1.0f : 0.0f);
      }
    SearchWindow window;
    window.prior = {terrain.center_odom + Eigen::Vector2d(3.0, -2.0), 0.0};
    window.half_width_m = 6.0;
    window.min_overlap = 0.4;
    const std::vector<Peak> peaks = find_peaks(OrbitalSection(plane_field(map, {1.5, 0.5})), terrain, window, 4.0, 3);
    EXPECT_FALSE(peaks.empty());
    return peaks.empty() ? Peak{} : peaks.front();
  };
  const Peak whole = peak_on(all_seen), part = peak_on(holed);
  EXPECT_GT(whole.score, 0.99);
  EXPECT_GT(part.score, 0.97);
  EXPECT_LT((part.pose.center_map - terrain.center_odom).norm(), 0.6);
}

// On a bowl, a tilt looks like a shift. Height drift here: 4 cm over the local map.
TEST(Refinement, TiltOfLocalMapDoesNotBiasPosition) {
  const auto bowl = [](double x, double y) {
    return hills(x, y) + 0.005 * (std::pow(x - 9.0, 2) + std::pow(y - 19.0, 2));
  };
  const auto tilted = [&](double x, double y) { return bowl(x, y) + 0.0016 * x; };
  const PlaneConfig filter{1.5, 0.5};
  TerrainTemplate terrain = terrain_template(grid_of(tilted, 50, 0.5), filter);
  HeightGrid map;
  map.lattice = {130, 130, 0.5, -23.0, -13.0};
  for (int row = 0; row < 130; ++row)
    for (int column = 0; column < 130; ++column)
      map.z_m.push_back(static_cast<float>(bowl(map.lattice.center_x_m(column), map.lattice.center_y_m(row))));
  map.weight.assign(map.z_m.size(), 1.0f);
  const OrbitalSection orbital(plane_field(map, filter));
  const auto error_m = [&](const DriftConfig& drift) {
    terrain.drift_information = drift_information(terrain, drift, 0.01 * 0.25);
    const CandidatePose start{terrain.center_odom + Eigen::Vector2d(0.4, -0.3), 0.01};
    return (refine(orbital, terrain, start, 100, {3.0, 0.05, 150}).pose.center_map - terrain.center_odom).norm();
  };
  EXPECT_LT(error_m({to_rad(0.04), 0.01}), 0.01);
  EXPECT_GT(error_m({to_rad(1e-4), 1e-5}), 0.02);
}

TEST(AttemptSchedule, AttemptsAreDueByDistanceDriven) {
  AttemptSchedule schedule({10.0, 20.0, 5.0});
  EXPECT_FALSE(schedule.due(300.0));  // the first map, late in a drive
  EXPECT_FALSE(schedule.due(309.9));
  EXPECT_TRUE(schedule.due(310.0));
  schedule.record_attempt(310.0, false);
  EXPECT_FALSE(schedule.due(314.9));
  EXPECT_TRUE(schedule.due(315.0));
  schedule.record_attempt(315.0, true);
  EXPECT_FALSE(schedule.due(334.9));
  EXPECT_TRUE(schedule.due(335.0));
  schedule.restart();
  EXPECT_FALSE(schedule.due(336.0));
}

}  // namespace
}  // namespace rover::global::test
