// A lost rover is searched for within 500 m: right, or no fix. Prints a table of test/results/large_map.md; exit status
// 1: a place was wrong, or a search took more than 10 s. Lines, worlds and seeds were never used to set the
// configuration.
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "common/core/frames.hpp"
#include "common/geo/elevation_map.hpp"
#include "global_localization/config.hpp"
#include "global_localization/global_localization.hpp"
#include "rover_simulator/world/noise.hpp"
#include "test/geo/stretched_terrain.hpp"
#include "test/global_localization/bench_world.hpp"
#include "test/global_localization/mapped_drive.hpp"

using namespace rover;
using namespace rover::global;
using namespace rover::global::test;

namespace {

constexpr double kSideM = 1600.0;
constexpr int kDrives = 10, kTriesPerMap = 3;
constexpr double kDriveM = 100.0, kFirstMapM = 40.0, kMapEveryM = 10.0;
constexpr double kSigmaM = 500.0 / 3.0, kSigmaRad = to_rad(4.0), kOffsetRad = to_rad(10.0);
constexpr std::uint64_t kLineSeed = 6042, kWorldSeed = 7042, kDriveSeed = 8042, kTrialSeed = 9042;

double cpu_s() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Row {
  std::string name;
  double cell_m;
  double min_offset_m, max_offset_m;  // of the prior from the true place
  int tries = 0, featured = 0, right = 0, wrong = 0;
  std::map<std::string, int> reasons;
  std::vector<double> error_m, time_s;
};

double quantile(std::vector<double> values, double p) {
  if (values.empty()) return kNaN;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<size_t>(p * static_cast<double>(values.size())))];
}

Prior prior_off(const MappedDrive& drive, const Row& row, HashStream& random) {
  const double r = random.range(row.min_offset_m, row.max_offset_m), a = random.range(-kPi, kPi);
  const Eigen::Vector2d place = drive.T_map_body().translation() + r * Eigen::Vector2d(std::cos(a), std::sin(a));
  Prior prior;
  prior.p_odom_body = drive.T_odom_body().translation();
  prior.T_map_odom.yaw_rad =
      Eigen::Rotation2Dd(drive.T_map_odom().linear()).angle() + random.range(-kOffsetRad, kOffsetRad);
  const Eigen::Vector2d t = place - Eigen::Rotation2Dd(prior.T_map_odom.yaw_rad) * prior.p_odom_body;
  prior.T_map_odom.x_m = t.x();
  prior.T_map_odom.y_m = t.y();
  prior.cov = Eigen::Vector3d(kSigmaM * kSigmaM, kSigmaM * kSigmaM, kSigmaRad * kSigmaRad).asDiagonal();
  return prior;
}

void attempt(const GlobalLocalization& core, const MappedDrive& drive, HashStream& random, Row& row) {
  const Prior prior = prior_off(drive, row, random);
  const double start_s = cpu_s();
  const Correction found = core.correct(prior);
  row.time_s.push_back(cpu_s() - start_s);
  ++row.tries;
  if (core.featured(found)) ++row.featured;
  if (!found.accepted) {
    ++row.reasons[std::string(found.reason)];
    return;
  }
  const Pose2& T = found.T_map_odom;
  const Eigen::Vector2d place = Eigen::Vector2d(T.x_m, T.y_m) + Eigen::Rotation2Dd(T.yaw_rad) * prior.p_odom_body;
  const double error_m = (place - drive.T_map_body().translation()).norm();
  row.error_m.push_back(error_m);
  ++(error_m <= row.cell_m ? row.right : row.wrong);
}

struct Case {
  GlobalLocalization core;
  std::vector<Row*> rows;
};

void drive_through(const World& world, const Line& line, int number, std::vector<Case>& cases) {
  MappedDrive drive(world, line, DriveErrors{}, kDriveSeed + static_cast<std::uint64_t>(number));
  HashStream random(hash_cell(kTrialSeed, number, 0));
  for (Case& c : cases) c.core.clear_local_map();
  double next_m = kFirstMapM;
  while (drive.driven_m() < kDriveM) {
    drive.advance();
    for (Case& c : cases) c.core.add_elevation(drive.view(), drive.T_odom_body().translation());
    if (drive.driven_m() < next_m) continue;
    next_m += kMapEveryM;
    for (Case& c : cases)
      for (Row* row : c.rows)
        for (int k = 0; k < kTriesPerMap; ++k) attempt(c.core, drive, random, *row);
  }
}

void print(const Row& row) {
  std::string reasons;
  for (const auto& [reason, count] : row.reasons)
    reasons += (reasons.empty() ? "" : ", ") + std::to_string(count) + " " + reason;
  char error[40] = "–";
  if (!row.error_m.empty())
    std::snprintf(error, sizeof error, "%.2f / %.2f", quantile(row.error_m, 0.5), quantile(row.error_m, 1.0));
  std::printf("| %s | %.1f | %d | %d | %d | %d | %s | %.1f | %s |\n", row.name.c_str(), row.cell_m, row.tries,
              row.featured, row.right, row.wrong, error, quantile(row.time_s, 1.0), reasons.c_str());
}

}  // namespace

int main() {
  const std::string root = ROVER_SOURCE_DIR;
  const ElevationRaster dtm = testing_support::stretched_terrain(
      read_elevation_map(root + "/config/terrain/gale/gale_hirise_dtm_1m_348x337.tif").raster, kSideM, 1.0);
  const GlobalConfig config = load_config(root + "/config").core;
  WorldConfig world_config;
  world_config.orbital.distortion_m = 0.0;
  const World world(world_config, dtm, kWorldSeed);
  std::vector<Row> rows;
  for (const double cell_m : {0.5, 1.0}) {
    rows.push_back({"within 480 m", cell_m, 0.0, 480.0});
    rows.push_back({"outside, 650 to 900 m off", cell_m, 650.0, 900.0});
  }
  std::vector<Case> cases;
  for (size_t i = 0; i < rows.size(); i += 2) {
    HeightGrid orbital = grid_of(world.orbital_map(rows[i].cell_m));
    cases.push_back({GlobalLocalization(config, std::move(orbital), 0.1), {&rows[i], &rows[i + 1]}});
  }
  std::fprintf(stderr, "maps made\n");
  const std::vector<Line> lines = drivable_lines(world, kDriveM, kDrives, kLineSeed);
  for (size_t i = 0; i < lines.size(); ++i) {
    drive_through(world, lines[i], static_cast<int>(i), cases);
    std::fprintf(stderr, "drive %zu of %zu\n", i + 1, lines.size());
  }
  std::printf(
      "| true place | m/px | searches | with enough relief | right | wrong by more than a cell | error p50 / max m | "
      "CPU "
      "p50 / max s | no fix, why |\n|---|---|---|---|---|---|---|---|---|\n");
  bool good = true;
  for (const Row& row : rows) {
    print(row);
    const bool outside = row.min_offset_m > 500.0;
    good = good && row.wrong == 0 && (!outside || row.right == 0) && quantile(row.time_s, 1.0) <= 10.0;
  }
  return good ? 0 : 1;
}
