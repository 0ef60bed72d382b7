// Global correction over simulated drives: local maps matched from many wrong poses on orbital maps of two resolutions,
// and on plains, where relief tells nothing, local pictures on pictures from orbit.
// Prints the tables of test/results/correction.md; exit status 1: a gate failed.
//
// Featured maps have an expected sigma within acceptance.max_expected_sigma_cells and _deg of the configuration
// (services/global_localization/terrain_template.hpp). Lines, worlds and seeds of this program were
// never used to set the configuration.
#include <time.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <string>
#include <vector>

#include "common/core/frames.hpp"
#include "common/geo/elevation_map.hpp"
#include "global_localization/config.hpp"
#include "global_localization/global_localization.hpp"
#include "rover_simulator/camera/ground_picture.hpp"
#include "rover_simulator/orbital_picture.hpp"
#include "rover_simulator/world/noise.hpp"
#include "test/global_localization/bench_world.hpp"
#include "test/global_localization/mapped_drive.hpp"

using namespace rover;
using namespace rover::global;
using namespace rover::global::test;

namespace {

constexpr int kDrives = 12;
constexpr double kDriveM = 150.0, kFirstMapM = 40.0, kMapEveryM = 5.0;
constexpr int kTriesPerMap = 7;
const std::string kOtherPlace = "map of another place", kFlat = "flat ground";
constexpr double kOffsetM = 10.0, kOffsetRad = to_rad(10.0);
// Pictures: wrong is what shows another place. Pixels are smaller than what fine odometry needs.
constexpr double kOtherPlaceM = 1.0, kPictureM = 0.25;
constexpr int kPlains = 8, kTriesPerPicture = 18;
constexpr int kRealStrips = 100;
constexpr double kRealSigmaCells = 2.0;  // the elevation model shows nothing finer
constexpr double kRealNearM = 2.5;
constexpr double kResolutions[] = {0.5, 1.0};
constexpr double kRockAreas[] = {0.02, 0.05, 0.08, 0.12};
constexpr std::uint64_t kLineSeed = 2042, kWorldSeed = 3042, kDriveSeed = 4042, kTrialSeed = 5042;

double cpu_s() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double quantile(std::vector<double> values, double p) {
  if (values.empty()) return kNaN;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<size_t>(p * static_cast<double>(values.size())))];
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double yaw_of(const Eigen::Isometry2d& T) {
  return Eigen::Rotation2Dd(T.linear()).angle();
}

// One orbital map of one world, with the results of its trials.
struct Row {
  std::string name;
  double cell_m = 0.0;
  bool must_abstain = false;  // from a fix along two axes
  bool other_place = false;   // the map shows none of the ground
  bool demanded = true;       // else the row is shown, and not judged
  bool by_picture = false;    // cell_m is then a pixel's side
  int maps = 0, featured_maps = 0, tries = 0, featured_tries = 0, accepted = 0, one_axis = 0, wrong = 0;
  std::vector<double> error_m, error_deg, truth_m, along_m, time_s;
  std::vector<double> nees;  // of fixes along two axes against the truth, per degree of freedom: 1 if consistent
};

struct Trial {
  Eigen::Vector2d offset;
  double yaw_rad;
};

Trial draw(HashStream& random, double min_m, double max_m) {
  const double r = random.range(min_m, max_m), a = random.range(-kPi, kPi);
  return {{r * std::cos(a), r * std::sin(a)}, random.range(-kOffsetRad, kOffsetRad)};
}

// Prior with the trial's error: offset at the rover, and rotation about it.
Prior prior_of(const MappedDrive& drive, const Eigen::Isometry2d& T_map_odom, const Trial& trial) {
  Prior prior;
  prior.p_odom_body = drive.T_odom_body().translation();
  prior.T_map_odom.yaw_rad = yaw_of(T_map_odom) + trial.yaw_rad;
  const Eigen::Vector2d t =
      T_map_odom * prior.p_odom_body + trial.offset - Eigen::Rotation2Dd(prior.T_map_odom.yaw_rad) * prior.p_odom_body;
  prior.T_map_odom.x_m = t.x();
  prior.T_map_odom.y_m = t.y();
  prior.cov = Eigen::Vector3d(16.0, 16.0, std::pow(to_rad(4.0), 2)).asDiagonal();
  return prior;
}

Eigen::Isometry2d isometry(const Pose2& pose) {
  Eigen::Isometry2d T = Eigen::Isometry2d::Identity();
  T.translate(Eigen::Vector2d(pose.x_m, pose.y_m)).rotate(Eigen::Rotation2Dd(pose.yaw_rad));
  return T;
}

// `on_map`: T_map_odom as the distorted map shows the terrain; `truth`: the true one.
void attempt_once(const GlobalLocalization& core, const MappedDrive& drive, const Trial& trial,
                  const Eigen::Isometry2d& on_map, Row& row) {
  const Eigen::Isometry2d truth = drive.T_map_odom();
  const Prior prior = prior_of(drive, on_map, trial);
  const double start_s = cpu_s();
  const Correction found = core.correct(prior);
  row.time_s.push_back(cpu_s() - start_s);
  ++row.tries;
  if (core.featured(found)) ++row.featured_tries;
  if (!found.accepted) return;
  const Eigen::Isometry2d T = isometry(found.T_map_odom);
  const Eigen::Vector2d error = T * prior.p_odom_body - on_map * prior.p_odom_body;
  if (found.axes == 1) {
    ++row.one_axis;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(found.cov.topLeftCorner<2, 2>());
    row.along_m.push_back(std::abs(axes.eigenvectors().col(0).dot(error)));
    // A place outside of the window can be inside along the axis; on a map of another place nothing is right.
    if (row.along_m.back() > row.cell_m || row.other_place) ++row.wrong;
    return;
  }
  ++row.accepted;
  const double error_m = error.norm();
  if (error_m > (row.by_picture ? kOtherPlaceM : row.cell_m) || row.must_abstain) ++row.wrong;
  row.error_m.push_back(error_m);
  row.error_deg.push_back(to_deg(std::abs(wrap_angle(yaw_of(T) - yaw_of(on_map)))));
  const Eigen::Vector2d off = T * prior.p_odom_body - truth * prior.p_odom_body;
  row.truth_m.push_back(off.norm());
  const Eigen::Vector3d e(off.x(), off.y(), wrap_angle(yaw_of(T) - yaw_of(truth)));
  row.nees.push_back(e.dot(found.cov.inverse() * e) / 3.0);
}

struct OrbitalCase {
  GlobalLocalization core;
  MapDistortion distortion;
  Row* row;
  double min_offset_m, max_offset_m;
  int tries;
};

// `side_m`: of the local map or picture. `picture`: of the ground, as the rover sees it; null without.
void drive_through(const Surface& world, const Line& line, std::uint64_t seed, double side_m,
                   const ElevationRaster* picture, std::vector<OrbitalCase>& cases) {
  MappedDrive drive(world, line, DriveErrors{}, seed, picture);
  HashStream random(hash_cell(kTrialSeed, static_cast<std::int64_t>(seed), 0));
  double next_m = kFirstMapM;
  while (drive.driven_m() < kDriveM) {
    drive.advance();
    for (OrbitalCase& c : cases) c.core.add_elevation(drive.view(), drive.T_odom_body().translation());
    if (drive.driven_m() < next_m) continue;
    next_m += kMapEveryM;
    const std::vector<Eigen::Vector2d> ground = drive.seen_ground(0.5 * side_m);
    for (OrbitalCase& c : cases) {
      const Eigen::Isometry2d on_map = c.distortion.rigid(ground) * drive.T_map_odom();
      const int featured = c.row->featured_tries;
      for (int k = 0; k < c.tries; ++k)
        attempt_once(c.core, drive, draw(random, c.min_offset_m, c.max_offset_m), on_map, *c.row);
      ++c.row->maps;
      if (c.row->featured_tries > featured) ++c.row->featured_maps;
    }
  }
}

ElevationRaster mirrored(ElevationRaster raster) {
  for (int row = 0; row < raster.height; ++row)
    std::reverse(raster.z_m.begin() + static_cast<std::ptrdiff_t>(row) * raster.width,
                 raster.z_m.begin() + static_cast<std::ptrdiff_t>(row + 1) * raster.width);
  return raster;
}

struct Bench {
  GlobalConfig config;
  std::vector<Row> rows;

  Row& row(const std::string& name, double cell_m, bool must_abstain, bool demanded = true) {
    for (Row& r : rows)
      if (r.name == name && r.cell_m == cell_m) return r;
    rows.push_back({name, cell_m, must_abstain, name == kOtherPlace || name == kFlat, demanded});
    return rows.back();
  }

  void add_cases(const WorldConfig& world_config, const ElevationRaster& dtm, std::uint64_t seed, double cell_m,
                 std::vector<OrbitalCase>& cases) {
    WorldConfig straight = world_config;
    straight.orbital.distortion_m = 0.0;
    const World plain(straight, dtm, seed), bent(world_config, dtm, seed);
    const ElevationRaster plain_map = plain.orbital_map(cell_m);
    const MapDistortion none(straight, dtm, seed, cell_m);
    const auto core = [&](const ElevationRaster& map) { return GlobalLocalization(config, grid_of(map), 0.1); };
    cases.push_back({core(plain_map), none, &row("noise 0.1 m", cell_m, false), 0.0, kOffsetM, kTriesPerMap});
    cases.push_back({core(bent.orbital_map(cell_m)), MapDistortion(world_config, dtm, seed, cell_m),
                     &row("noise 0.1 m, distortion 0.3 m", cell_m, false, false), 0.0, kOffsetM, kTriesPerMap});
    cases.push_back({core(plain_map), none, &row("true place outside the window", cell_m, true), 22.0, 30.0, 2});
    cases.push_back({core(mirrored(plain_map)), none, &row(kOtherPlace, cell_m, true), 0.0, kOffsetM, 2});
  }

  void drive(const ElevationRaster& dtm, const Line& line, int number) {
    WorldConfig world_config;
    world_config.rocks.k = kRockAreas[number % 4];
    const std::uint64_t seed = kWorldSeed + static_cast<std::uint64_t>(number);
    std::vector<OrbitalCase> cases;
    for (double cell_m : kResolutions) add_cases(world_config, dtm, seed, cell_m, cases);
    const World world(world_config, dtm, seed);
    drive_through(world, line, kDriveSeed + static_cast<std::uint64_t>(number), config.mosaic_side_m, nullptr, cases);
    std::fprintf(stderr, "drive %d of %d\n", number + 1, kDrives);
  }

  Row& picture_row(const std::string& name, double cell_m, bool must_abstain, bool demanded = true) {
    Row& r = row(name, cell_m, must_abstain, demanded);
    r.by_picture = true;
    return r;
  }

  // The rover's sun is in the north-west, the orbiter's anywhere.
  void drive_plain(int number) {
    const bool one_soil = number % 2 == 1;
    const std::uint64_t seed = kWorldSeed + 200 + static_cast<std::uint64_t>(number);
    HashStream random(seed);
    WorldConfig bent_config;
    bent_config.rocks.k = kRockAreas[number % 4];
    if (one_soil) bent_config.soil.everywhere = Soil::kFirm;
    WorldConfig world_config = bent_config;
    world_config.orbital.distortion_m = 0.0;
    const ElevationRaster dtm = plane_raster(240.0, 240.0, 1.0, to_rad(1.0), 0.3);
    const World world(world_config, dtm, seed), bent(bent_config, dtm, seed);
    GroundAppearanceConfig look;
    look.seed = seed;
    look.sun_elevation_rad = to_rad(40.0);
    look.sun_azimuth_rad = to_rad(135.0);
    const ElevationRaster ground = ground_picture(world, look, world.width_m(), world.length_m(), 1);
    OrbitalPictureConfig orbiter{.resolution_m = kPictureM};
    orbiter.sun_azimuth_rad = random.range(-kPi, kPi);
    orbiter.sun_elevation_rad = random.range(to_rad(25.0), to_rad(65.0));
    const ElevationRaster picture = orbital_picture(world, orbiter, look, 1);
    const ElevationRaster bent_picture = orbital_picture(bent, orbiter, look, 1);
    const ElevationRaster map = world.orbital_map(1.0);
    const auto core = [&](const ElevationRaster& raster) {
      return GlobalLocalization(config, grid_of(map), 0.1, OrbitalMap(grid_of(raster)));
    };
    const MapDistortion none(world_config, dtm, seed, 1.0), distortion(bent_config, dtm, seed, 1.0);
    const std::string kind = one_soil ? "plain of one soil" : "plain";
    std::vector<OrbitalCase> cases;
    cases.push_back({core(picture), none, &picture_row(kind, kPictureM, false), 0.0, kOffsetM, kTriesPerPicture});
    cases.push_back({core(bent_picture), distortion, &picture_row(kind + ", distortion 0.3 m", kPictureM, false, false),
                     0.0, kOffsetM, 3});
    cases.push_back(
        {core(picture), none, &picture_row(kind + ", true place outside the window", kPictureM, true), 22.0, 30.0, 2});
    cases.push_back({core(mirrored(picture)), none, &picture_row(kind + ", picture of another place", kPictureM, true),
                     0.0, kOffsetM, 2});
    const Line line{{50.0, 120.0}, 0.1};
    drive_through(world, line, kDriveSeed + 200 + static_cast<std::uint64_t>(number), config.picture.mosaic_side_m,
                  &ground, cases);
    std::fprintf(stderr, "plain %d of %d\n", number + 1, kPlains);
  }

  void drive_flat(double slope_rad, double k, int number) {
    WorldConfig world_config;
    world_config.rocks.k = k;
    world_config.orbital.distortion_m = 0.0;
    const ElevationRaster dtm = plane_raster(240.0, 240.0, 1.0, slope_rad, 0.3);
    const std::uint64_t seed = kWorldSeed + 100 + static_cast<std::uint64_t>(number);
    const World world(world_config, dtm, seed);
    std::vector<OrbitalCase> cases;
    for (double cell_m : kResolutions)
      cases.push_back({GlobalLocalization(config, grid_of(world.orbital_map(cell_m)), 0.1),
                       MapDistortion(world_config, dtm, seed, cell_m), &row(kFlat, cell_m, true), 0.0, kOffsetM, 2});
    const Line line{{50.0, 120.0}, 0.1};
    drive_through(world, line, kDriveSeed + 100 + static_cast<std::uint64_t>(number), config.mosaic_side_m, nullptr,
                  cases);
  }
};

bool holds(const Row& row) {
  const bool quick = quantile(row.time_s, 1.0) <= 0.3;
  if (row.by_picture && !row.must_abstain)
    return quick && row.wrong == 0 && row.accepted >= 0.8 * row.tries && quantile(row.error_m, 0.95) <= row.cell_m;
  if (row.must_abstain) return quick && row.accepted == 0 && row.wrong == 0;
  return quick && row.wrong == 0 && row.accepted >= 0.9 * row.featured_tries &&
         quantile(row.error_m, 0.95) <= 0.5 * row.cell_m && quantile(row.error_deg, 0.95) <= 0.5;
}

void print_quantiles(const std::vector<double>& values, std::initializer_list<double> ps) {
  std::string text;
  for (const double p : ps) {
    char number[20];
    std::snprintf(number, sizeof number, "%s%.2f", text.empty() ? "" : " / ", quantile(values, p));
    text += number;
  }
  std::printf("%s | ", values.empty() ? "" : text.c_str());
}

// The columns that both tables end with.
void print_common(const Row& row) {
  print_quantiles(row.truth_m, {0.95});
  print_quantiles(row.error_deg, {0.5, 0.95});
  print_quantiles(row.nees.empty() ? row.nees : std::vector<double>{mean(row.nees)}, {1.0});
  std::printf("%.0f / %.0f | %s |\n", 1e3 * quantile(row.time_s, 0.5), 1e3 * quantile(row.time_s, 1.0),
              !row.demanded ? "not judged"
              : holds(row)  ? "yes"
                            : "NO");
}

void print(const Row& row) {
  const double share = row.featured_tries > 0 ? 100.0 * row.accepted / row.featured_tries : 0.0;
  std::printf("| %s | %.1f | %d / %d | %d / %d | %d (%.1f %%) | %d | %.0f %% | %d | ", row.name.c_str(), row.cell_m,
              row.featured_maps, row.maps, row.featured_tries, row.tries, row.accepted, share, row.one_axis,
              100.0 * (row.accepted + row.one_axis) / std::max(row.tries, 1), row.wrong);
  print_quantiles(row.error_m, {0.5, 0.95, 1.0});
  print_quantiles(row.along_m, {0.95, 1.0});
  print_common(row);
}

void print_picture(const Row& row) {
  std::printf("| %s | %.2f | %d | %d | %d (%.1f %%) | %d | ", row.name.c_str(), row.cell_m, row.maps, row.tries,
              row.accepted, 100.0 * row.accepted / std::max(row.tries, 1), row.wrong);
  print_quantiles(row.error_m, {0.5, 0.95, 1.0});
  print_common(row);
}

// Brightness of the ground under a sun in the direction `sun`.
ElevationRaster shaded(const ElevationRaster& dtm, const Eigen::Vector3d& sun) {
  ElevationRaster out = dtm;
  for (int row = 0; row < dtm.height; ++row)
    for (int column = 0; column < dtm.width; ++column) {
      const int west = std::max(column - 1, 0), east = std::min(column + 1, dtm.width - 1);
      const int south = std::max(row - 1, 0), north = std::min(row + 1, dtm.height - 1);
      const double slope_x = (dtm.at(east, row) - dtm.at(west, row)) / ((east - west) * dtm.resolution_m);
      const double slope_y = (dtm.at(column, north) - dtm.at(column, south)) / ((north - south) * dtm.resolution_m);
      out.at(column, row) = static_cast<float>(Eigen::Vector3d(-slope_x, -slope_y, 1.0).normalized().dot(sun));
    }
  return out;
}

// Strips of 60 x 20 m of the shaded relief of Gale's elevation model on the picture from orbit of the same ground. The
// two are aligned to a few metres: the offset is unknown, but the same everywhere.
void match_real_picture(const GlobalConfig& config, const ElevationRaster& dtm, const std::string& picture_file) {
  const ElevationRaster picture = read_picture(picture_file, dtm);
  // The picture's own light is not given: of six directions the one that fits best.
  const double azimuth_rad = to_rad(145.0), elevation_rad = to_rad(45.0);
  const ElevationRaster relief =
      shaded(dtm, {std::cos(elevation_rad) * std::cos(azimuth_rad), std::cos(elevation_rad) * std::sin(azimuth_rad),
                   std::sin(elevation_rad)});
  GlobalConfig coarse = config;
  coarse.picture.filter.sigma_cells = kRealSigmaCells;
  HashStream random(kTrialSeed);
  std::vector<Eigen::Vector2d> offsets;
  std::vector<double> x, y;
  int accepted = 0;
  for (int k = 0; k < kRealStrips; ++k) {
    const Eigen::Vector2d place(random.range(60.0, dtm.width_m() - 60.0), random.range(60.0, dtm.height_m() - 60.0));
    const Line line{place, random.range(-kPi, kPi), 0.0};
    Prior prior;
    prior.T_map_odom = {place.x(), place.y(), line.heading_rad};
    prior.cov = Eigen::Vector3d(16.0, 16.0, std::pow(to_rad(4.0), 2)).asDiagonal();
    GlobalLocalization core(coarse, grid_of(dtm), 0.1, OrbitalMap(grid_of(picture)));
    for (double back_m = 60.0; back_m >= 0.0; back_m -= 20.0) {
      ElevationView view;
      view.lattice = {200, 200, 0.1, -back_m - 10.0, -10.0};
      for (int i = 0; i < 200 * 200; ++i) {
        const Eigen::Vector2d p_odom(view.lattice.center_x_m(i % 200), view.lattice.center_y_m(i / 200));
        const Eigen::Vector2d p = place + Eigen::Rotation2Dd(line.heading_rad) * p_odom;
        view.z_m.push_back(0.0F);
        view.sigma_m.push_back(0.01F);
        view.brightness.push_back(relief.at(std::clamp(static_cast<int>(p.x()), 0, relief.width - 1),
                                            std::clamp(static_cast<int>(p.y()), 0, relief.height - 1)));
      }
      core.add_elevation(view, {-back_m, 0.0});
    }
    const Correction found = core.correct_by_picture(prior);
    accepted += found.accepted ? 1 : 0;
    offsets.emplace_back(found.T_map_odom.x_m - place.x(), found.T_map_odom.y_m - place.y());
    x.push_back(offsets.back().x());
    y.push_back(offsets.back().y());
  }
  const Eigen::Vector2d common(quantile(x, 0.5), quantile(y, 0.5));
  const auto near = std::count_if(offsets.begin(), offsets.end(),
                                  [&](const Eigen::Vector2d& off) { return (off - common).norm() < kRealNearM; });
  std::printf(
      "\nReal picture: of %d strips, %d accepted; the best place of %d is within %.1f m of (%.1f, %.1f) m, "
      "their median.\n",
      kRealStrips, accepted, static_cast<int>(near), kRealNearM, common.x(), common.y());
}

}  // namespace

int main() {
  const std::string root = ROVER_SOURCE_DIR;
  const ElevationRaster dtm = read_elevation_map(root + "/config/terrain/gale/gale_hirise_dtm_1m_348x337.tif").raster;
  Bench bench{load_config(root + "/config").core, {}};
  bench.rows.reserve(40);  // rows are pointed to
  const std::vector<Line> lines = drivable_lines(World(WorldConfig{}, dtm, kWorldSeed), kDriveM, kDrives, kLineSeed);
  for (size_t i = 0; i < lines.size(); ++i) bench.drive(dtm, lines[i], static_cast<int>(i));
  bench.drive_flat(0.0, 0.0, 0);
  bench.drive_flat(0.0, 0.08, 1);
  bench.drive_flat(to_rad(8.0), 0.05, 2);
  for (int i = 0; i < kPlains; ++i) bench.drive_plain(i);
  std::printf(
      "| orbital map | m/px | featured / local maps | tries on featured / all | accepted (of featured) | along one "
      "axis | a "
      "fix, of all | wrong by more than a cell | error on the map p50 / p95 / max m | along one axis p95 / max m | "
      "against "
      "truth p95 m | yaw p50 / p95 deg | NEES | CPU p50 / max ms | holds |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  bool all = true;
  for (const Row& row : bench.rows) {
    if (!row.by_picture) print(row);
    all = all && (!row.demanded || holds(row));
  }
  std::printf(
      "\n| picture | m/px | local pictures | tries | accepted | wrong by more than 1 m | error on the picture p50 / "
      "p95 / "
      "max m | against truth p95 m | yaw p50 / p95 deg | NEES | CPU p50 / max ms | holds |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Row& row : bench.rows)
    if (row.by_picture) print_picture(row);
  match_real_picture(bench.config, dtm, root + "/config/terrain/gale/gale_hirise_ortho_0p64m_512x512.tif");
  return all ? 0 : 1;
}
