// Visual odometry on recorded images: the Minnie rover (shipped) and KITTI (evaluation only, not shipped).
#include "recorded.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <vector>

#include "visual_odometry/odometry.hpp"

namespace rover::vo {
namespace {

// Folder of KITTI odometry sequence 06, frames 0-50.
std::string kitti_folder() {
  const char* given = std::getenv("ROVER_SHARED_DATA");
  const std::string root = given ? given : ROVER_SOURCE_DIR "/../shared/data";
  return root + "/kitti_06_0_50";
}

std::string numbered(int i) {
  std::ostringstream name;
  name << std::setw(6) << std::setfill('0') << i << ".png";
  return name.str();
}

std::vector<Eigen::Isometry3d> read_poses(const std::string& file) {
  std::ifstream in(file);
  std::vector<Eigen::Isometry3d> poses;
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream numbers(line);
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 4; ++c) numbers >> T.matrix()(r, c);
    poses.push_back(T);
  }
  return poses;
}

TEST(Recorded, KittiDriftBelowOnePercent) {
  const std::string folder = kitti_folder();
  if (!std::filesystem::exists(folder + "/poses.txt")) GTEST_SKIP() << "no recorded drive at " << folder;
  const std::vector<Eigen::Isometry3d> truth = read_poses(folder + "/poses.txt");
  ASSERT_EQ(truth.size(), 51U);
  Odometry odometry(OdometryConfig{});
  const StereoCamera camera{
      1226, 370, 707.0912, 601.8873, 183.1104, 379.8145 / 707.0912, Eigen::Isometry3d::Identity()};
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  double length = 0.0;
  for (int i = 0; i < 51; ++i) {
    StereoFrame frame;
    frame.utime = 1000 + i * 100'000;
    frame.left = read_gray(folder + "/image_l/" + numbered(i));
    frame.right = read_gray(folder + "/image_r/" + numbered(i));
    frame.camera = camera;
    const auto result = odometry.step(frame);
    if (i == 0) continue;
    ASSERT_TRUE(result.has_value());
    ASSERT_EQ(result->status, Status::kOk) << "frame " << i << " inliers " << result->inliers;
    T = T * result->T_prev_cur;
    length += (truth[i].translation() - truth[i - 1].translation()).norm();
  }
  const double error = (T.translation() - (truth[0].inverse() * truth[50]).translation()).norm();
  RecordProperty("end_error_percent", std::to_string(100.0 * error / length));
  std::cout << "end error " << 100.0 * error / length << " % of " << length << " m\n";
  EXPECT_NEAR(length, 59.9, 0.1);
  EXPECT_LE(error / length, 0.010);
}

TEST(Recorded, MinnieMotionWithinFiveMillimetres) {
  const std::string base = ROVER_SOURCE_DIR "/test/data/minnie/MinnieRectDeg3";
  const StereoCamera camera{
      640, 400, 1018.6 / 3.0, 956.501 / 3.0, 617.314 / 3.0, 0.2675, Eigen::Isometry3d::Identity()};
  Odometry odometry(OdometryConfig{});
  StereoFrame frame{1000, read_gray(base + "Left.png"), read_gray(base + "Right.png"), std::nullopt, camera, {}};
  ASSERT_EQ(frame.left.width, 640);
  EXPECT_FALSE(odometry.step(frame).has_value());
  frame.utime = 501'000;
  frame.left = read_gray(base + "LeftNext.png");
  frame.right = read_gray(base + "RightNext.png");
  const auto result = odometry.step(frame);
  ASSERT_TRUE(result.has_value());
  EXPECT_EQ(result->status, Status::kOk);
  const double given = 0.159;  // from the left camera's poses in the data set
  EXPECT_NEAR(result->T_prev_cur.translation().norm(), given, 0.005);
  std::cout << "moved " << result->T_prev_cur.translation().transpose() << " norm "
            << result->T_prev_cur.translation().norm() << " given " << given << " inliers " << result->inliers << " of "
            << result->features << " rms " << result->rms_px << "\n";
}

}  // namespace
}  // namespace rover::vo
