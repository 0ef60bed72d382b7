// Prints what the cores compute from recorded images and seeded inputs: one line "<output>,<value>" a number, with all
// its digits. test/arm64.sh compares the lines of two processors.
#include <algorithm>
#include <cstdio>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <random>
#include <string>

#include "common/stereo/stereo.hpp"
#include "hazard_detector/hazard_detector.hpp"
#include "slam/slam.hpp"
#include "test/localization/synthetic_drive.hpp"
#include "test/path_planner/plan_scene.hpp"
#include "test/slam/navcam.hpp"
#include "test/stereo/synthetic_world.hpp"
#include "test/traversability/synthetic_terrain.hpp"
#include "traversability/traversability.hpp"
#include "visual_odometry/odometry.hpp"

namespace rover {
namespace {

void print(const char* output, double value) {
  std::printf("%s,%.17g\n", output, value);
}

template <class Values>
void print_all(const char* output, const Values& values) {
  for (const auto value : values) print(output, static_cast<double>(value));
}

void print_matrix(const char* output, const Eigen::MatrixXd& matrix) {
  print_all(output, matrix.reshaped());
}

void print_pose(const char* output, const Pose2& pose) {
  print_all(output, Eigen::Vector3d(pose.x_m, pose.y_m, pose.yaw_rad));
}

GrayImage recorded(const std::string& file) {
  const cv::Mat pixels = cv::imread(ROVER_SOURCE_DIR "/test/data/" + file, cv::IMREAD_GRAYSCALE);
  GrayImage image(pixels.cols, pixels.rows);
  std::copy(pixels.begin<std::uint8_t>(), pixels.end<std::uint8_t>(), image.data.begin());
  return image;
}

// The field trial's images are rectified: no distortion, no rotation.
StereoRig recorded_rig(const GrayImage& image) {
  StereoRig rig;
  rig.width = image.width;
  rig.height = image.height;
  rig.left = rig.right = {339.532, 339.532, 318.834, 205.771, {}};
  rig.T_left_right.translation().x() = 0.2675;
  return rig;
}

void run_stereo() {
  const GrayImage left = recorded("minnie/MinnieRectLeftDeg3.png"), right = recorded("minnie/MinnieRectRightDeg3.png");
  stereo::StereoConfig config;
  config.ground_reference = false;
  config.matcher.residual_min_px = 0;
  const stereo::StereoResult result = stereo::Stereo(config, recorded_rig(left), 0.0).step(left, right).value();
  print_all("rectified image", result.left.data);
  print_all("disparity", result.disparity.px16);
}

void run_visual_odometry() {
  vo::Odometry odometry(vo::OdometryConfig{});
  vo::StereoFrame frame;
  frame.camera = {672, 376, 339.532, 318.834, 205.771, 0.2675, Eigen::Isometry3d::Identity()};
  for (const std::string next : {"", "Next"}) {
    frame.utime += 400'000;
    frame.left = recorded("minnie/MinnieRectDeg3Left" + next + ".png");
    frame.right = recorded("minnie/MinnieRectDeg3Right" + next + ".png");
    frame.camera.width = frame.left.width;
    frame.camera.height = frame.left.height;
    if (const auto result = odometry.step(frame)) {
      print_matrix("visual odometry", result->T_prev_cur.matrix());
      print_matrix("visual odometry", result->cov);
    }
  }
}

void run_hazard_detector() {
  const StereoCamera camera = synthetic::loccam_camera();
  hazard::HazardDetector detector(hazard::HazardConfig{});
  std::mt19937_64 random(1);
  for (int i = 0; i < 50; ++i) {
    synthetic::World world;
    world.slope_x = 0.01 * (i % 10 - 5);
    world.rocks.push_back({1.0 + 0.02 * i, 0.0, 0.15, 0.1 + 0.004 * i, false, false});
    const std::vector<float> exact = synthetic::exact_disparity(world, camera);
    const hazard::HazardResult result =
        detector.step(synthetic::noisy_disparity(exact, camera, 0.0, 0.0, random), camera);
    print("hazards", result.coverage);
    for (const hazard::Cell cell : result.cells) print("hazards", static_cast<int>(cell));
  }
}

void run_localization() {
  loc::SyntheticDrive drive(loc::LocalizationConfig{}, 1);
  drive.command = [](double t) { return t < 1.5 ? loc::Twist{} : loc::Twist{0.2, 0.06 * std::sin(0.1 * t)}; };
  drive.align_and_start();
  drive.run(120.0, [&drive] {
    const loc::PoseEstimate& pose = drive.localization.pose();
    print_matrix("localization input", drive.truth().matrix());
    print_matrix("localization", (pose.T_map_odom * pose.T_odom_body).matrix());
    print("localization", pose.cov.trace());
  });
}

void run_slam() {
  using namespace slam::testing_support;
  slam::Random random(1);
  slam::Slam core{slam::SlamConfig{}};
  const NavcamModel camera{.step_px = 8};
  Pose2 truth, odometry;
  for (int i = 0; i < 40; ++i) {
    truth = slam::compose(truth, {0.5, 0.0, 0.02});
    odometry = slam::compose(odometry, {0.505, 0.002, 0.021});
    const slam::Cloud cloud = cloud_of(Ground{}, upright(truth, kOriginHeightM), camera, random, i * 2'500'000);
    for (const auto& point : cloud.points) print_all("slam input", point.p_cam_m);
    const slam::SlamResult result = core.step(cloud, {upright(odometry, kOriginHeightM), 0.01 * i, 0.001 * i, 0.0});
    print_pose("slam pose", result.T_slam_odom);
    print_matrix("slam covariance", result.covariance);
  }
}

void run_traversability() {
  for (int seed = 1; seed <= 5; ++seed) {
    trav::testing_support::SyntheticMap spec;
    spec.noise_m = 0.01;
    const trav::TerrainGrid grid = trav::testing_support::synthetic_terrain(
        [](double x, double y) {
          return 0.15 * std::sin(0.9 * x + 0.4 * y) + trav::testing_support::block_m(x - 3.0, y + 1.0, 0.3, 0.4);
        },
        spec, static_cast<std::uint64_t>(seed));
    print_all("traversability input", grid.height_m);
    print_all("traversability", trav::compute_traversability(grid, {}).cells);
  }
}

void run_path_planner() {
  using namespace planning::testing_support;
  const planning::HybridPlanner planner(search_config());
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const planning::Plan plan = planner.plan(plan_request(certain_belief(ground_of(random_rocks(seed)))));
    print("plan search", plan.expansions);
    print("plan search", plan.cost);
    for (const planning::PlanPose& at : plan.poses) print_pose("plan", at.pose);
  }
}

}  // namespace
}  // namespace rover

int main() {
  cv::setNumThreads(1);
  rover::run_stereo();
  rover::run_visual_odometry();
  rover::run_hazard_detector();
  rover::run_localization();
  rover::run_slam();
  rover::run_traversability();
  rover::run_path_planner();
}
