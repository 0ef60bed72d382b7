// Drift that errors of the stereo calibration cause: calibration_study FIRST_SEED LAST_SEED METRES ERROR_PX.
//
// Each seed is a drive over rendered ground with cameras that differ from their calibration by ERROR_PX rms. Motions
// are joined with the true attitude, so that what is left is the scale and the direction of the translation.
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "../rover_simulator/camera_test_world.hpp"
#include "common/stereo/stereo.hpp"
#include "rover_simulator/camera/stereo_camera_sim.hpp"
#include "visual_odometry/odometry.hpp"

namespace rover::vo {
namespace {

constexpr double kStepM = 0.08;  // 0.2 m/s at 2.5 Hz
constexpr Utime kPeriod = 400'000;

struct Drive {
  std::vector<StereoFrame> frames;
  std::vector<Eigen::Isometry3d> truth;
  DisparityCorrection correction;
};

// Error of the right camera less that of the left one, in the direction of (x, y) [px].
Eigen::Vector2d error_px(const StereoRig& nominal, const StereoRig& real, double x, double y) {
  const auto ideal = [&](PinholeCamera camera) {
    camera.distortion = {};
    return camera;
  };
  const Eigen::Vector3d ray(x, y, 1.0);
  const Eigen::Matrix3d R = real.T_left_right.linear().transpose() * nominal.T_left_right.linear();
  const Eigen::Vector2d right = project(ideal(real.right), R * ray) - project(ideal(nominal.right), ray);
  return right - (project(ideal(real.left), ray) - project(ideal(nominal.left), ray));
}

DisparityCorrection true_correction(const StereoRig& nominal, const StereoRig& real) {
  const double border = 0.5 * nominal.width / nominal.left.fx_px;
  return {error_px(nominal, real, 0.0, 0.0).x(),
          (error_px(nominal, real, border, 0.0) - error_px(nominal, real, -border, 0.0)).y() / 2.0,
          (error_px(nominal, real, 0.0, border) - error_px(nominal, real, 0.0, -border)).y() / 2.0};
}

// Over the smooth part of the surface.
Eigen::Isometry3d ride(double x, double y, double yaw) {
  return make_pose(rotation_from_rpy(0.0, 0.0, yaw), {x, y, 0.25 * std::sin(0.2 * x) * std::cos(0.23 * y) + 0.68});
}

Drive render(std::uint64_t seed, double length_m, double error_px) {
  const test::RockySurface surface(0.0);
  CameraSimConfig config;
  config.calibration_error_px = error_px;
  config.scene = test::small_scene();
  StereoCameraSim camera(test::loccam_rig(), config, surface, seed);
  stereo::Stereo stereo({}, test::loccam_rig(), 0.62);
  Drive drive;
  drive.correction = true_correction(test::loccam_rig(), camera.true_rig());
  double x = 50.0 * static_cast<double>(seed), y = 0.0;
  for (int i = 0; i * kStepM <= length_m; ++i) {
    const double yaw = 0.4 * std::sin(0.02 * i);
    const Eigen::Isometry3d T_map_body = ride(x, y, yaw);
    const StereoCameraSim::Pair pair = camera.render(T_map_body, i);
    stereo::StereoResult rectified = stereo.step(pair.left, pair.right).value();
    drive.frames.push_back({kPeriod * (i + 1), std::move(rectified.left), std::move(rectified.right),
                            std::move(rectified.disparity), stereo.camera(), std::nullopt});
    drive.truth.push_back(T_map_body);
    x += kStepM * std::cos(yaw);
    y += kStepM * std::sin(yaw);
  }
  return drive;
}

void judge(const char* name, const Drive& drive, const OdometryConfig& config) {
  Odometry odometry(config);
  Eigen::Vector3d position = drive.truth.front().translation();
  double length_m = 0.0, heading_rad = 0.0;
  size_t start = 0;
  int lost = 0;
  for (size_t i = 0; i < drive.frames.size(); ++i) {
    if (i > 0) length_m += (drive.truth[i].translation() - drive.truth[i - 1].translation()).norm();
    const auto result = odometry.step(drive.frames[i]);
    if (!result) continue;
    if (!is_finite(result->T_prev_cur)) {
      ++lost;
      continue;
    }
    position += drive.truth[start].linear() * result->T_prev_cur.translation();
    heading_rad += yaw_of(result->T_prev_cur) - yaw_of(drive.truth[start].inverse() * drive.truth[i]);
    start = i;
  }
  const Eigen::Vector3d error = position - drive.truth.back().translation();
  const Eigen::Vector3d along = (drive.truth.back().translation() - drive.truth.front().translation()).normalized();
  std::printf(
      "%-22s end error %6.3f %%, along %+6.3f %%, up %+6.3f %%, yaw %+6.3f deg, lost %d; yaw %+.3f, roll %+.3f, focal "
      "%+.3f px\n",
      name, 100.0 * error.norm() / length_m, 100.0 * error.dot(along) / length_m, 100.0 * error.z() / length_m,
      to_deg(heading_rad), lost, odometry.correction().yaw_px, odometry.correction().roll_px,
      odometry.correction().focal_px);
  std::fflush(stdout);
}

}  // namespace
}  // namespace rover::vo

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr, "calibration_study FIRST_SEED LAST_SEED METRES ERROR_PX\n");
    return 2;
  }
  using namespace rover::vo;
  for (int seed = std::atoi(argv[1]); seed <= std::atoi(argv[2]); ++seed) {
    const Drive drive = render(static_cast<std::uint64_t>(seed), std::atof(argv[3]), std::atof(argv[4]));
    std::printf("seed %d: yaw %+.3f, roll %+.3f, focal %+.3f px\n", seed, drive.correction.yaw_px,
                drive.correction.roll_px, drive.correction.focal_px);
    OdometryConfig config;
    config.disparity_offset.max_px = config.disparity_offset.information_factor = 0.0;
    judge("calibration as given", drive, config);
    judge("calibrated on the way", drive, {});
  }
  return 0;
}
