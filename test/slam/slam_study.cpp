// Drift of SLAM compared with odometry on simulated drives, and registration of recorded clouds.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>

#include "common/core/check.hpp"
#include "slam/config.hpp"
#include "test/slam/study_drive.hpp"
#include "test/slam/teide_study.hpp"

namespace rover::slam::study {
namespace {

const std::string kRoot = ROVER_SOURCE_DIR;
const std::string kDtm = kRoot + "/config/terrain/gale/gale_hirise_dtm_1m_348x337.tif";

struct Drift {
  double odometry_percent = 0.0, slam_percent = 0.0;
  int observable = 0, clouds = 0;
};

// Horizontal error at the end, with aligned start poses, over the distance driven.
double drift_percent(const std::vector<Station>& drive, const Pose2& end) {
  const Pose2 truth = between(planar(drive.front().T_map_body), planar(drive.back().T_map_body));
  double travelled_m = 0.0;
  for (size_t i = 1; i < drive.size(); ++i)
    travelled_m += (drive[i].T_map_body.translation() - drive[i - 1].T_map_body.translation()).norm();
  return 100.0 * std::hypot(end.x_m - truth.x_m, end.y_m - truth.y_m) / travelled_m;
}

Drift run_slam(const std::vector<Station>& drive, const OdometryTrack& odometry, const SlamConfig& config) {
  Slam slam(config);
  Drift drift;
  for (size_t i = 0; i < drive.size(); ++i) {
    const SlamResult result =
        slam.step(drive[i].cloud, {odometry.T_odom_body[i], odometry.sigma_m[i], 0.0, odometry.dead_reckoned_m[i]});
    ROVER_CHECK(result.rejection.empty(), result.rejection);
    drift.observable += result.status == Status::kOk ? 1 : 0;
    ++drift.clouds;
  }
  const Pose2 end = planar(odometry.T_odom_body.back());
  drift.odometry_percent = drift_percent(drive, end);
  drift.slam_percent = drift_percent(drive, compose(slam.T_slam_odom(), end));
  return drift;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

struct Summary {
  std::vector<double> slam, odometry;
  int lower = 0;       // drives with less drift than odometry
  double worst = 0.0;  // ratio
  void add(const Drift& d) {
    slam.push_back(d.slam_percent);
    odometry.push_back(d.odometry_percent);
    lower += d.slam_percent < d.odometry_percent ? 1 : 0;
    worst = std::max(worst, d.slam_percent / d.odometry_percent);
  }
  void print(const std::string& name) const {
    fmt::print(
        "- {}: slam_drift_percent median {:.2f} (odometry {:.2f}), lower in {} of {}, at worst {:.2f} times "
        "odometry's\n",
        name, median(slam), median(odometry), lower, slam.size(), worst);
  }
};

void drift_study(const DriveConfig& form, int first, int last) {
  const SlamConfig config = load_config(kRoot + "/config").core;
  Summary nominal, degraded;
  fmt::print(
      "| seed | odometry | SLAM | informed | degraded odometry | SLAM | informed |\n|---|---|---|---|---|---|---|\n");
  for (int seed = first; seed <= last; ++seed) {
    DriveConfig drive_config = form;
    drive_config.seed = static_cast<std::uint64_t>(seed);
    const std::vector<Station> drive = simulated_drive(drive_config, kDtm);
    const Drift a = run_slam(drive, simulated_odometry(drive, nominal_odometry(), drive_config.seed), config);
    const Drift b = run_slam(drive, simulated_odometry(drive, degraded_odometry(), drive_config.seed), config);
    nominal.add(a);
    degraded.add(b);
    fmt::print("| {} | {:.2f} % | {:.2f} % | {}/{} | {:.2f} % | {:.2f} % | {}/{} |\n", seed, a.odometry_percent,
               a.slam_percent, a.observable, a.clouds, b.odometry_percent, b.slam_percent, b.observable, b.clouds);
    std::fflush(stdout);
  }
  fmt::print("\n");
  nominal.print("nominal odometry");
  degraded.print("degraded odometry");
}

}  // namespace
}  // namespace rover::slam::study

int main(int argc, char** argv) {
  using namespace rover::slam::study;
  CLI::App app("Drift of SLAM against odometry's on simulated drives; registration of recorded clouds");
  int first = 1, last = 10;
  DriveConfig form;
  std::string data;
  auto* drift = app.add_subcommand("drift", "drives over Gale crater's floor with rocks");
  drift->add_option("--first", first);
  drift->add_option("--last", last);
  drift->add_option("--length-m", form.length_m);
  drift->add_option("--rocks-k", form.rock_k);
  drift->add_option("--disparity-offset-px", form.disparity_offset_px, "error of the NavCam's calibration");
  drift->add_flag("--flat", form.flat, "a plane");
  auto* teide = app.add_subcommand("teide", "the GA SLAM authors' clouds");
  teide->add_option("folder", data)->required();
  app.require_subcommand(1);
  CLI11_PARSE(app, argc, argv);
  if (teide->parsed()) return teide_study(data) ? 0 : 1;
  drift_study(form, first, last);
  return 0;
}
