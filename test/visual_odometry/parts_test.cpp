// Unit tests of the components of visual odometry.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "synthetic_ground.hpp"
#include "visual_odometry/corner_detector.hpp"
#include "visual_odometry/epipolar_calibration.hpp"
#include "visual_odometry/motion_estimator.hpp"
#include "visual_odometry/patch_aligner.hpp"
#include "visual_odometry/projection.hpp"
#include "visual_odometry/rotation_buffer.hpp"
#include "visual_odometry/stereo_matcher.hpp"

namespace rover::vo {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2f;
using Eigen::Vector3d;

TEST(Projection, InvertsTriangulation) {
  const StereoCamera camera = loccam();
  const Vector3d p = camera.point(100.0, 300.0, 25.0);
  const Vector3d z = project(camera, p);
  EXPECT_NEAR(z.x(), 100.0, 1e-9);
  EXPECT_NEAR(z.y(), 300.0, 1e-9);
  EXPECT_NEAR(z.z(), 75.0, 1e-9);
}

TEST(Projection, JacobianEqualsCentralDifference) {
  const StereoCamera camera = loccam();
  const Vector3d p(0.3, -0.2, 1.7);
  const Eigen::Matrix3d J = project_jacobian(camera, p);
  for (int i = 0; i < 3; ++i) {
    Vector3d d = Vector3d::Zero();
    d(i) = 1e-6;
    const Vector3d numeric = (project(camera, p + d) - project(camera, p - d)) / 2e-6;
    EXPECT_LT((J.col(i) - numeric).norm(), 1e-5);
  }
}

std::vector<RowOffset> row_offsets(double pitch_px, double roll_px, double focal_px, std::mt19937_64& random) {
  std::uniform_real_distribution<double> side(-1.0, 1.0);
  std::normal_distribution<double> noise(0.0, 0.1);
  std::vector<RowOffset> offsets;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector2d at(side(random), 0.75 * side(random));
    const bool wrong = i % 5 == 0;  // all to one side
    offsets.push_back({at, wrong ? 1.4 : pitch_px + roll_px * at.x() + focal_px * at.y() + noise(random)});
  }
  return offsets;
}

TEST(EpipolarCalibration, FindsRollAndFocalLengthAmongWrongMatches) {
  std::mt19937_64 random(1);
  EpipolarCalibration calibration(DisparityOffsetConfig{});
  for (int i = 0; i < 10; ++i) calibration.add(row_offsets(0.3, -0.25, 0.4, random));
  EXPECT_NEAR(calibration.roll_px(), -0.25, 0.03);
  EXPECT_NEAR(calibration.focal_px(), 0.4, 0.03);
}

TEST(EpipolarCalibration, IsBoundedAndNeedsMatches) {
  std::mt19937_64 random(2);
  EpipolarCalibration calibration(DisparityOffsetConfig{});
  calibration.add({});
  EXPECT_EQ(calibration.roll_px(), 0.0);
  for (int i = 0; i < 10; ++i) calibration.add(row_offsets(0.0, 1.0, -1.0, random));
  EXPECT_EQ(calibration.roll_px(), 0.5);
  EXPECT_EQ(calibration.focal_px(), -0.5);
}

// A smooth texture that can be sampled anywhere.
double wave(double x, double y) {
  return 110.0 + 25.0 * std::sin(0.7 * x + 0.2 * y) + 20.0 * std::sin(0.31 * x - 0.53 * y + 1.0) +
         15.0 * std::cos(0.11 * x + 0.83 * y);
}

cv::Mat wave_image(double dx, double dy, double gain = 1.0, double offset = 0.0) {
  cv::Mat image(80, 100, CV_8UC1);
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x)
      image.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(gain * wave(x - dx, y - dy) + offset);
  return image;
}

TEST(PatchAligner, SubPixelShiftIndependentOfExposure) {
  Patch patch;
  ASSERT_TRUE(make_patch(wave_image(0, 0), {50, 40}, Eigen::Matrix2f::Identity(), patch));
  for (const Vector2f& shift : {Vector2f(0.3F, -0.6F), Vector2f(1.25F, 0.5F), Vector2f(-0.8F, 1.9F)}) {
    const Alignment a = align(patch, wave_image(shift.x(), shift.y(), 0.6, 20.0), {50, 40}, 4.0F);
    ASSERT_TRUE(a.ok);
    EXPECT_LT((a.position - Vector2f(50, 40) - shift).norm(), 0.06F);
    EXPECT_GT(a.score, 0.98F);
  }
}

TEST(PatchAligner, WarpedPatchAlignsWithScaledImage) {
  // The target is the source scaled by 1.3 about (50, 40).
  cv::Mat target(80, 100, CV_8UC1);
  for (int y = 0; y < 80; ++y)
    for (int x = 0; x < 100; ++x)
      target.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(wave(50 + (x - 50.4) / 1.3, 40 + (y - 39.7) / 1.3));
  Patch patch;
  ASSERT_TRUE(make_patch(wave_image(0, 0), {50, 40}, Eigen::Matrix2f::Identity() / 1.3F, patch));
  const Alignment a = align(patch, target, {50, 40}, 4.0F);
  ASSERT_TRUE(a.ok);
  EXPECT_LT((a.position - Vector2f(50.4F, 39.7F)).norm(), 0.06F);
  EXPECT_GT(a.score, 0.99F);
}

TEST(PatchAligner, RejectsFlatPatchesEdgesAndBorders) {
  Patch patch;
  const cv::Mat flat(80, 100, CV_8UC1, cv::Scalar(90));
  EXPECT_FALSE(make_patch(flat, {50, 40}, Eigen::Matrix2f::Identity(), patch));
  cv::Mat edge(80, 100, CV_8UC1, cv::Scalar(50));
  edge.colRange(50, 100).setTo(150);
  EXPECT_FALSE(make_patch(edge, {50, 40}, Eigen::Matrix2f::Identity(), patch)) << "unobservable along the edge";
  EXPECT_FALSE(make_patch(wave_image(0, 0), {3, 40}, Eigen::Matrix2f::Identity(), patch));
  ASSERT_TRUE(make_patch(wave_image(0, 0), {50, 40}, Eigen::Matrix2f::Identity(), patch));
  EXPECT_FALSE(align(patch, flat, {50, 40}, 4.0F).ok);
  EXPECT_FALSE(align(patch, wave_image(0, 0), {2, 40}, 4.0F).ok);
}

TEST(CornerDetector, KeepsMinimumDistanceAndSkipsFlatRegions) {
  SyntheticGround ground(1, false);
  StereoFrame frame = ground.frame(1, SyntheticGround::over_ground(0, 0, 0));
  cv::Mat image(frame.left.height, frame.left.width, CV_8UC1, frame.left.data.data());
  image.colRange(0, 256).setTo(100);
  const CornerConfig config;
  const auto corners = detect_corners(image, config);
  EXPECT_GT(corners.size(), 100U);
  for (size_t i = 0; i < corners.size(); ++i) {
    EXPECT_GT(corners[i].x(), 250.0F);
    for (size_t j = 0; j < i; ++j)
      EXPECT_GE((corners[i] - corners[j]).norm(), static_cast<float>(config.min_distance_px));
  }
}

TEST(StereoMatcher, MatchesGroundDisparityWithAndWithoutSeed) {
  SyntheticGround ground(2, false);
  const Isometry3d pose = SyntheticGround::over_ground(0, 0, 0);
  const StereoFrame frame = ground.frame(1, pose);
  const Disparity seed = ground.ground_disparity(pose);
  const ImagePyramid left = build_pyramid(frame.left, 4);
  const ImagePyramid right = build_pyramid(frame.right, 4);
  for (const bool with_seed : {true, false}) {
    double square = 0.0;
    int found = 0;
    const auto corners = detect_corners(left.base(), {});
    for (const Vector2f& corner : corners) {
      if (corner.x() < 90.0F) continue;  // outside the right image
      const auto match = match_corner(left, right, with_seed ? &seed : nullptr, corner, {});
      if (!match) continue;
      const double given = seed.px(static_cast<int>(corner.x()), static_cast<int>(corner.y()));
      if (std::abs(match->disparity_px - given) > 1.0) continue;
      square += std::pow(match->disparity_px - given, 2);
      ++found;
    }
    EXPECT_GT(found, static_cast<int>(corners.size()) / 2) << with_seed;
    EXPECT_LT(std::sqrt(square / found), 0.15) << with_seed;
  }
}

TEST(StereoMatcher, TexturelessImageHasNoMatch) {
  const GrayImage flat(512, 384, 100);
  const ImagePyramid left = build_pyramid(flat, 4);
  EXPECT_FALSE(match_corner(left, left, nullptr, {200, 200}, {}).has_value());
}

struct Scene {
  std::vector<Observation> observations;
  Isometry3d T_cur_key;
};

Scene scene(std::uint64_t seed, int good, int bad, double noise_px) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit;
  std::normal_distribution<double> normal(0.0, noise_px);
  const StereoCamera camera = loccam();
  Scene s;
  s.T_cur_key = make_pose(exp_so3({0.02, -0.03, 0.05}), {0.03, -0.02, -0.12});
  while (static_cast<int>(s.observations.size()) < good + bad) {
    const double d = 15.0 + 45.0 * unit(random);
    Observation o;
    o.disparity_px = d;
    o.p_key = camera.point(512.0 * unit(random), 384.0 * unit(random), d);
    o.z = project(camera, s.T_cur_key * o.p_key) + Vector3d(normal(random), normal(random), normal(random));
    o.has_right = s.observations.size() % 4 != 0;
    if (static_cast<int>(s.observations.size()) >= good) o.z += Vector3d(40.0 * unit(random) + 5.0, -20.0, 9.0);
    s.observations.push_back(o);
  }
  return s;
}

TEST(MotionEstimator, RansacFindsMotionWithHalfOutliers) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Scene s = scene(seed, 60, 60, 0.3);
    const RansacResult result = ransac(s.observations, loccam(), Isometry3d::Identity(), {}, seed);
    EXPECT_GE(result.inliers, 55) << seed;
  }
}

TEST(MotionEstimator, RefineConvergesToExactMotion) {
  Scene s = scene(3, 80, 0, 0.0);
  const MotionEstimate e = refine(s.observations, loccam(), Isometry3d::Identity(), {});
  EXPECT_LT((e.T_cur_key.matrix() - s.T_cur_key.matrix()).norm(), 1e-8);
  EXPECT_EQ(e.inliers, 80);
}

TEST(MotionEstimator, RefineIgnoresOutliers) {
  const Scene s = scene(4, 100, 30, 0.0);
  const MotionEstimate e = refine(s.observations, loccam(), s.T_cur_key, {});
  EXPECT_EQ(e.inliers, 100);
  EXPECT_LT((e.T_cur_key.translation() - s.T_cur_key.translation()).norm(), 1e-3);
}

TEST(MotionEstimator, CovarianceMatchesMonteCarlo) {
  MotionConfig config;
  config.disparity_sigma_px = 1e-6;  // the points are exact here
  double nees = 0.0;
  constexpr int kRuns = 200;
  for (int i = 0; i < kRuns; ++i) {
    const Scene s = scene(static_cast<std::uint64_t>(i + 1), 80, 0, config.pixel_sigma_px);
    const MotionEstimate e = refine(s.observations, loccam(), s.T_cur_key, config);
    const Isometry3d off = e.T_cur_key * s.T_cur_key.inverse();
    Eigen::Matrix<double, 6, 1> x;
    x << off.translation(), log_so3(off.linear());
    nees += x.dot(e.cov.inverse() * x) / kRuns;
  }
  EXPECT_NEAR(nees, 6.0, 1.5);
}

// One Gauss-Newton step from data with a known offset.
TEST(MotionEstimator, OffsetMeasurementFindsOffset) {
  constexpr double kOffset = 0.2;
  Scene s = scene(6, 200, 0, 0.0);
  for (Observation& o : s.observations) {
    o.has_right = true;
    o.p_key *= o.disparity_px / (o.disparity_px - kOffset);  // measured disparity is too small by the offset
    o.disparity_px -= kOffset;
    o.z.z() += kOffset;
  }
  const MotionEstimate e = refine(s.observations, loccam(), s.T_cur_key, {});
  EXPECT_GT(e.offset.information, 0.0);
  EXPECT_NEAR(e.offset.gradient / e.offset.information, kOffset, 0.03);
}

TEST(DisparityOffset, TellsAKnockFromACalibrationError) {
  const auto displaced_after = [](double true_px, double information) {
    DisparityOffset offset{{}};
    int keyframes = 0;
    for (; keyframes < 100 && !offset.displaced(); ++keyframes)
      offset.add({information * (true_px - offset.px()), information}, offset.px());
    return keyframes;
  };
  for (const double sign : {1.0, -1.0}) {
    EXPECT_LE(displaced_after(sign * 3.6, 100.0), 3);
    EXPECT_EQ(displaced_after(sign * 0.9, 1000.0), 100);
    EXPECT_EQ(displaced_after(sign * 0.3, 100.0), 100);
  }
  EXPECT_EQ(displaced_after(3.6, 0.0), 100) << "at rest nothing is measured";
}

TEST(DisparityOffset, CombinesMeasurementWithPriorAndIsBounded) {
  DisparityOffsetConfig config;
  config.information_factor = 1.0;
  DisparityOffset offset(config);
  offset.add({25.0 * 0.2, 25.0}, 0.0);  // 0.2 px, with the same information as the prior
  EXPECT_NEAR(offset.px(), 0.1, 1e-12);
  offset.add({kNaN, 1e9}, 0.0);
  offset.add({1.0, -5.0}, 0.0);
  EXPECT_NEAR(offset.px(), 0.1, 1e-12);
  offset.add({1e9 * 5.0, 1e9}, 0.0);
  EXPECT_EQ(offset.px(), config.max_px);
}

TEST(MotionEstimator, TooFewPointsGiveNaN) {
  Scene s = scene(5, 2, 0, 0.0);
  const MotionEstimate e = refine(s.observations, loccam(), Isometry3d::Identity(), {});
  EXPECT_FALSE(is_finite(e.T_cur_key));
  EXPECT_FALSE(e.cov.allFinite());
}

GyroIncrement increment(Utime utime, const Vector3d& rate) {
  return {utime, 0.02, rate * 0.02};
}

TEST(RotationBuffer, IntegratesIncrementsAndClipsEnds) {
  RotationBuffer buffer(10'000'000);
  for (Utime t = 20'000; t <= 1'000'000; t += 20'000) ASSERT_TRUE(buffer.add(increment(t, {0.0, 0.0, 0.25})));
  const auto R = buffer.rotation(210'000, 610'000);
  ASSERT_TRUE(R.has_value());
  EXPECT_NEAR(log_so3(*R).z(), 0.1, 1e-9);
}

TEST(RotationBuffer, GapsAndInvalidIncrementsGiveNoRotation) {
  RotationBuffer buffer(10'000'000);
  for (Utime t = 20'000; t <= 1'000'000; t += 20'000)
    if (t != 500'000) buffer.add(increment(t, {0.0, 0.0, 0.25}));
  EXPECT_FALSE(buffer.rotation(200'000, 600'000).has_value());
  EXPECT_TRUE(buffer.rotation(520'000, 900'000).has_value());
  EXPECT_FALSE(buffer.rotation(900'000, 1'100'000).has_value()) << "increments are missing at the end";
  EXPECT_FALSE(buffer.add(increment(900'000, {0.0, 0.0, 0.0}))) << "not in time order";
  EXPECT_FALSE(buffer.add(increment(1'020'000, {0.0, kNaN, 0.0})));
  EXPECT_FALSE(buffer.add(increment(1'020'000, {0.0, 0.0, 100.0})));
}

}  // namespace
}  // namespace rover::vo
