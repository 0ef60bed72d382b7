// Drift of SLAM against that of odometry on simulated drives.
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <map>
#include <string>

#include "common/core/check.hpp"
#include "slam/slam.hpp"
#include "test/slam/study_drive.hpp"

namespace rover::slam::study {
namespace {

const std::string kDtm = std::string(ROVER_SOURCE_DIR) + "/config/terrain/gale/gale_hirise_dtm_1m_348x337.tif";

struct Drift {
  double odometry_percent = 0.0, slam_percent = 0.0;
  int informed = 0, clouds = 0;
  double particles = 0.0, ms = 0.0;
};

// Horizontal error at the end, start poses laid on one another, over the way.
double drift_percent(const std::vector<Station>& drive, const Pose2& end) {
  const Pose2 truth = between(planar(drive.front().T_map_body), planar(drive.back().T_map_body));
  double way = 0.0;
  for (size_t i = 1; i < drive.size(); ++i)
    way += (drive[i].T_map_body.translation() - drive[i - 1].T_map_body.translation()).norm();
  return 100.0 * std::hypot(end.x_m - truth.x_m, end.y_m - truth.y_m) / way;
}

Drift judged(const std::vector<Station>& drive, const OdometryTrack& odometry, const SlamConfig& config, bool trace) {
  Slam slam(config);
  Drift drift;
  for (size_t i = 0; i < drive.size(); ++i) {
    const auto begin = std::chrono::steady_clock::now();
    const SlamResult result = slam.step(drive[i].cloud, {odometry.T_odom_body[i], odometry.sigma_m[i], 0.0});
    drift.ms += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    ROVER_CHECK(result.refusal.empty(), result.refusal);
    drift.informed += result.status == Status::kOk;
    drift.particles += result.particles;
    ++drift.clouds;
    if (trace && i % 10 == 0) {
      const Pose2 truth = between(planar(drive[0].T_map_body), planar(drive[i].T_map_body));
      const Pose2 now = compose(result.T_slam_odom, planar(odometry.T_odom_body[i])),
                  o = planar(odometry.T_odom_body[i]);
      const Pose2 e = between(truth, now), eo = between(truth, o);
      fmt::print(
          "  {:3d} odo {:+.3f} {:+.3f} {:+.3f}deg slam {:+.3f} {:+.3f} {:+.3f}deg sigma {:.4f} {:.4f} {:.4f}deg info "
          "{:.1f} n {} st {}\n",
          i, eo.x_m, eo.y_m, to_deg(eo.yaw_rad), e.x_m, e.y_m, to_deg(e.yaw_rad), std::sqrt(result.covariance(0, 0)),
          std::sqrt(result.covariance(1, 1)), to_deg(std::sqrt(result.covariance(2, 2))), result.information,
          result.particles, static_cast<int>(result.status));
    }
  }
  drift.odometry_percent = drift_percent(drive, planar(odometry.T_odom_body.back()));
  drift.slam_percent = drift_percent(drive, compose(slam.T_slam_odom(), planar(odometry.T_odom_body.back())));
  return drift;
}

}  // namespace
}  // namespace rover::slam::study

int main(int argc, char** argv) {
  using namespace rover::slam;
  using namespace rover::slam::study;
  std::map<std::string, double> set;
  for (int i = 1; i < argc; ++i) {
    const std::string text = argv[i];
    const auto at = text.find('=');
    set[text.substr(0, at)] = at == std::string::npos ? 1.0 : std::atof(text.c_str() + at + 1);
  }
  const auto given = [&](const char* key, double value) { return set.contains(key) ? set[key] : value; };
  SlamConfig config;
  config.match.temper = given("temper", config.match.temper);
  config.match.model_sigma_m = given("model", config.match.model_sigma_m);
  config.match.blur_m = given("blur", config.match.blur_m);
  config.match.kernel_sigma = given("kernel", config.match.kernel_sigma);
  config.match.height_sigma_m = given("height", config.match.height_sigma_m);
  config.match.tilt_sigma_rad = given("tilt", config.match.tilt_sigma_rad);
  config.motion.along_share = given("along", config.motion.along_share);
  config.motion.across_share = given("across", config.motion.across_share);
  config.motion.yaw_rad_per_m = rover::to_rad(given("yaw", 0.02));
  config.filter.min_particles = static_cast<int>(given("min", config.filter.min_particles));
  config.filter.max_particles = static_cast<int>(given("max", config.filter.max_particles));
  config.map.patches.step_m = given("step", config.map.patches.step_m);
  config.map.min_sigma_m = given("floor", config.map.min_sigma_m);
  config.map.growth_m2_per_m = given("growth", config.map.growth_m2_per_m);
  config.map.patches.correlated_points = given("corr", config.map.patches.correlated_points);
  const int first = static_cast<int>(given("first", 1)), last = static_cast<int>(given("last", 3));
  DriveConfig drive_config;
  drive_config.flat = given("flat", 0) > 0;
  drive_config.rock_k = given("k", 0.08);
  drive_config.disparity_offset_px = given("offset", 0.0);
  for (int seed = first; seed <= last; ++seed) {
    drive_config.seed = static_cast<std::uint64_t>(seed);
    const auto drive = simulated_drive(drive_config, kDtm);
    for (const bool degraded : {false, true}) {
      const auto model = degraded ? degraded_odometry() : nominal_odometry();
      const auto odometry = simulated_odometry(drive, model, drive_config.seed);
      const Drift d = judged(drive, odometry, config, given("trace", 0) > 0);
      fmt::print("seed {} {} odometry {:.3f} % slam {:.3f} % informed {}/{} particles {:.0f} points {} ms {:.1f}\n",
                 seed, degraded ? "degraded" : "nominal ", d.odometry_percent, d.slam_percent, d.informed, d.clouds,
                 d.particles / d.clouds, drive[drive.size() / 2].cloud.points.size(), d.ms / d.clouds);
      std::fflush(stdout);
    }
  }
}
