#include "common/stereo/stereo.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

#include "common/core/frames.hpp"
#include "test/stereo/synthetic_world.hpp"
#include "test/wild.hpp"

namespace rover::stereo {
namespace {

using Eigen::Vector3d;

constexpr double kGroundBelow = 0.62;

struct Errors {
  double rms_px = 0.0;    // of the pixels within 1 px
  double coverage = 0.0;  // measured share of what both cameras see
  double outliers = 0.0;  // fraction of measured pixels with an error above 1 px
};

Errors compare(const Disparity& disparity, const std::vector<float>& exact, int from_row = 0) {
  double squares = 0.0;
  int seen = 0, measured = 0, wrong = 0;
  for (int v = from_row; v < disparity.height; ++v)
    for (int u = 0; u < disparity.width; ++u) {
      const float truth = exact[static_cast<size_t>(v) * disparity.width + u];
      if (truth <= 0.0f) continue;
      ++seen;
      if (!disparity.valid(u, v)) continue;
      ++measured;
      const double error = disparity.px(u, v) - truth;
      if (std::abs(error) > 1.0)
        ++wrong;
      else
        squares += error * error;
    }
  return {std::sqrt(squares / std::max(1, measured - wrong)), double(measured) / seen, double(wrong) / measured};
}

// Flat ground with the body pitched about its origin.
synthetic::World pitched(double pitch_deg) {
  synthetic::World world;
  world.slope_x = std::tan(to_rad(pitch_deg));
  return world;
}

class StereoTest : public testing::Test {
 protected:
  StereoTest() : rig_(synthetic::loccam_rig()), stereo_({}, rig_, kGroundBelow) { cv::setNumThreads(1); }

  StereoResult see(const synthetic::World& world, double sigma_grey = 1.0, std::uint64_t seed = 5) {
    const synthetic::RawPair pair = synthetic::render(world, rig_, sigma_grey, seed);
    return *stereo_.step(pair.left, pair.right);
  }

  StereoRig rig_;
  Stereo stereo_;
};

TEST_F(StereoTest, FlatGroundIsDenseWithinTenthOfPixel) {
  const auto exact = synthetic::exact_disparity({}, stereo_.camera());
  const StereoResult result = see({});
  const Errors all = compare(result.disparity, exact);
  EXPECT_GT(all.coverage, 0.95);
  EXPECT_LT(all.outliers, 0.002);
  // Ground from 0.4 to 1.8 m ahead, where the synthetic texture is well sampled.
  EXPECT_LT(compare(result.disparity, exact, 128).rms_px, 0.10);
  EXPECT_LT(all.rms_px, 0.20);
}

TEST_F(StereoTest, SlopesOfTenDegreesAreWithinSearchRange) {
  for (double pitch_deg : {-10.0, 10.0}) {
    const synthetic::World world = pitched(pitch_deg);
    const Errors errors = compare(see(world).disparity, synthetic::exact_disparity(world, stereo_.camera()), 160);
    EXPECT_GT(errors.coverage, 0.95) << pitch_deg;
    EXPECT_LT(errors.rms_px, 0.12) << pitch_deg;
    EXPECT_LT(errors.outliers, 0.005) << pitch_deg;
  }
}

TEST_F(StereoTest, SubpixelErrorDoesNotDependOnFraction) {
  // A gentle slope covers all sub-pixel fractions.
  const synthetic::World world = pitched(3.0);
  const auto exact = synthetic::exact_disparity(world, stereo_.camera());
  const StereoResult result = see(world);
  std::vector<double> sum(10, 0.0), count(10, 0.0);
  for (int v = 128; v < 384; ++v)
    for (int u = 80; u < 512; ++u) {
      const double truth = exact[static_cast<size_t>(v) * 512 + u], error = result.disparity.px(u, v) - truth;
      if (!result.disparity.valid(u, v) || std::abs(error) > 1.0) continue;
      const size_t bin = static_cast<size_t>(10.0 * (truth - std::floor(truth)));
      sum[bin] += error;
      count[bin] += 1.0;
    }
  for (size_t bin = 0; bin < sum.size(); ++bin) {
    ASSERT_GT(count[bin], 1000.0);
    EXPECT_LT(std::abs(sum[bin] / count[bin]), 0.06) << bin;
  }
}

TEST_F(StereoTest, RockHeightIsMeasured) {
  synthetic::World world;
  world.rocks = {{1.5, 0.2, 0.25, 0.2}, {2.0, -0.3, 0.3, 0.3, true}};
  const StereoCamera& camera = stereo_.camera();
  const StereoResult result = see(world);
  double top_round = 0.0, top_box = 0.0;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      if (!result.disparity.valid(u, v)) continue;
      const Eigen::Vector3d p = camera.T_body_cam * camera.point(u, v, result.disparity.px(u, v));
      const double height = p.z() + kGroundBelow;
      if (std::hypot(p.x() - 1.5, p.y() - 0.2) < 0.1) top_round = std::max(top_round, height);
      if (std::abs(p.x() - 2.0) < 0.2 && std::abs(p.y() + 0.3) < 0.2) top_box = std::max(top_box, height);
    }
  EXPECT_NEAR(top_round, 0.2, 0.02);
  EXPECT_NEAR(top_box, 0.3, 0.03);
}

TEST_F(StereoTest, TexturelessRockIsInvalid) {
  synthetic::World world;
  world.rocks = {{1.8, 0.0, 0.25, 0.25, false, true}};
  const StereoResult result = see(world, 1.5);
  const StereoCamera& camera = stereo_.camera();
  int inside = 0, measured = 0;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector3d ray = camera.T_body_cam.linear() * camera.point(u, v, camera.focal_px * camera.baseline_m);
      if (synthetic::cast(world, camera.T_body_cam.translation(), ray).rock != 0) continue;
      ++inside;
      measured += result.disparity.valid(u, v);
    }
  ASSERT_GT(inside, 5000);
  // A rim half a block wide is matched by the ground's texture.
  EXPECT_LT(measured, 0.15 * inside);
}

TEST_F(StereoTest, SensorNoiseAloneGivesNoDisparity) {
  for (double sigma : {0.5, 1.0, 2.0, 4.0}) {
    std::mt19937_64 random(3);
    std::normal_distribution<double> grey(100.0, sigma);
    GrayImage left(512, 384), right(512, 384);
    for (auto* image : {&left, &right})
      for (auto& pixel : image->data) pixel = static_cast<std::uint8_t>(std::lround(grey(random)));
    const Disparity disparity = stereo_.step(left, right)->disparity;
    EXPECT_LT(std::count_if(disparity.px16.begin(), disparity.px16.end(), [](int d) { return d > 0; }), 200) << sigma;
  }
}

TEST_F(StereoTest, BlankPairIsAllInvalid) {
  const Disparity disparity = stereo_.step(GrayImage(512, 384, 0), GrayImage(512, 384, 0))->disparity;
  EXPECT_TRUE(
      std::all_of(disparity.px16.begin(), disparity.px16.end(), [](int d) { return d == Disparity::kInvalid; }));
}

TEST_F(StereoTest, ReferencePlaneChangesSearchRangeNotResult) {
  StereoConfig plain;
  plain.ground_reference = false;
  plain.matcher.residual_min_px = 0;
  plain.matcher.residual_count_px = 96;
  const synthetic::RawPair pair = synthetic::render({}, rig_, 1.0, 5);
  const Disparity a = stereo_.step(pair.left, pair.right)->disparity;
  const Disparity b = Stereo(plain, rig_, kGroundBelow).step(pair.left, pair.right)->disparity;
  std::vector<double> difference;
  for (size_t i = 0; i < a.px16.size(); ++i)
    if (a.px16[i] > 0 && b.px16[i] > 0) difference.push_back(std::abs(a.px16[i] - b.px16[i]) / 16.0);
  ASSERT_GT(difference.size(), 100000u);
  std::nth_element(difference.begin(), difference.begin() + difference.size() / 2, difference.end());
  EXPECT_LT(difference[difference.size() / 2], 0.15);
}

TEST_F(StereoTest, RectifiedRowsAreAligned) {
  // Compares the unsheared rectified pair row by row; a row error of 0.5 px would cost coverage and accuracy.
  const StereoResult result = see({}, 0.0);
  const auto exact = synthetic::exact_disparity({}, stereo_.camera());
  const auto mean_difference = [&](int row_shift) {
    double sum = 0.0;
    int count = 0;
    for (int v = 200; v < 370; ++v)
      for (int u = 100; u < 500; ++u) {
        const double x = u - double(exact[static_cast<size_t>(v) * 512 + u]);
        const int x0 = static_cast<int>(x);
        const double w = x - x0;
        const double right = (1 - w) * result.right.at(x0, v + row_shift) + w * result.right.at(x0 + 1, v + row_shift);
        sum += std::abs(result.left.at(u, v) - right);
        ++count;
      }
    return sum / count;
  };
  EXPECT_LT(mean_difference(0), 0.6 * mean_difference(1));
  EXPECT_LT(mean_difference(0), 0.6 * mean_difference(-1));
}

TEST_F(StereoTest, ImageOfWrongSizeIsRejected) {
  EXPECT_FALSE(stereo_.step(GrayImage(512, 384), GrayImage(511, 384)));
  EXPECT_FALSE(stereo_.step(GrayImage(), GrayImage(512, 384)));
}

TEST_F(StereoTest, IsDeterministicByteForByte) {
  const synthetic::RawPair pair = synthetic::render({}, rig_, 1.0, 5);
  const Disparity first = stereo_.step(pair.left, pair.right)->disparity;
  EXPECT_EQ(first.px16, stereo_.step(pair.left, pair.right)->disparity.px16);
  EXPECT_EQ(first.px16, Stereo({}, rig_, kGroundBelow).step(pair.left, pair.right)->disparity.px16);
}

TEST(RectifierTest, IdealRigIsUnchanged) {
  StereoRig rig;
  rig.width = 640;
  rig.height = 400;
  rig.left = rig.right = {339.532, 339.532, 318.834, 205.771, {}};
  rig.T_left_right.translation().x() = 0.2675;
  const Rectifier rectifier(rig, {}, std::nullopt);
  EXPECT_NEAR(rectifier.camera().focal_px, 339.532, 0.01);
  EXPECT_NEAR(rectifier.camera().cx_px, 318.834, 0.01);
  EXPECT_NEAR(rectifier.camera().cy_px, 205.771, 0.01);
  EXPECT_NEAR(rectifier.camera().baseline_m, 0.2675, 1e-6);
  EXPECT_TRUE(rectifier.camera().T_body_cam.isApprox(rig.T_body_left, 1e-9));
}

// Image of a small light spot at the point's projection.
GrayImage picture_of_spot(const StereoRig& rig, const PinholeCamera& camera, const Eigen::Vector3d& p_camera) {
  const cv::Matx33d K(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
  std::vector<cv::Point2d> at;
  cv::fisheye::projectPoints(std::vector{cv::Point3d(p_camera.x(), p_camera.y(), p_camera.z())}, at, cv::Vec3d(),
                             cv::Vec3d(), K, std::vector(camera.distortion.begin(), camera.distortion.begin() + 4));
  GrayImage image(rig.width, rig.height, 0);
  for (int v = 0; v < rig.height; ++v)
    for (int u = 0; u < rig.width; ++u) {
      const double r2 = (u - at[0].x) * (u - at[0].x) + (v - at[0].y) * (v - at[0].y);
      image.data[static_cast<size_t>(v) * rig.width + u] = static_cast<std::uint8_t>(250.0 * std::exp(-r2 / 3.0));
    }
  return image;
}

Eigen::Vector2d middle_of_spot(const GrayImage& image) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int v = 0; v < image.height; ++v)
    for (int u = 0; u < image.width; ++u)
      sum += image.data[static_cast<size_t>(v) * image.width + u] * Eigen::Vector3d(u, v, 1.0);
  return sum.head<2>() / sum.z();
}

TEST(Fisheye, PointsProjectedByOpenCvRectifyToPinholeModel) {
  StereoRig rig = synthetic::loccam_rig();
  for (PinholeCamera* camera : {&rig.left, &rig.right}) {
    camera->model = DistortionModel::kEquidistant;
    camera->distortion = {-0.012, 0.018, -0.009, 0.0015};
    camera->fx_px = camera->fy_px = 300.0;
  }
  const Rectifier rectifier(rig, {}, std::nullopt);
  const StereoCamera& pinhole = rectifier.camera();
  EXPECT_NEAR(pinhole.baseline_m, rig.T_left_right.translation().norm(), 1e-9);
  const Eigen::Isometry3d T_rect_left = pinhole.T_body_cam.inverse() * rig.T_body_left;
  double worst_px = 0.0;
  for (const Eigen::Vector3d& p_left : {Vector3d(0.1, 0.0, 2.0), Vector3d(-0.9, -0.6, 1.5), Vector3d(1.0, 0.7, 1.8),
                                        Vector3d(0.8, -0.5, 1.2), Vector3d(-0.5, 0.55, 1.0)}) {
    const RectifiedPair pair = rectifier.rectify(picture_of_spot(rig, rig.left, p_left),
                                                 picture_of_spot(rig, rig.right, rig.T_left_right.inverse() * p_left));
    const Vector3d p = T_rect_left * p_left;
    const Eigen::Vector2d left(pinhole.cx_px + pinhole.focal_px * p.x() / p.z(),
                               pinhole.cy_px + pinhole.focal_px * p.y() / p.z());
    const Eigen::Vector2d right(left.x() - pinhole.focal_px * pinhole.baseline_m / p.z(), left.y());
    worst_px =
        std::max({worst_px, (middle_of_spot(pair.left) - left).norm(), (middle_of_spot(pair.right) - right).norm()});
  }
  EXPECT_LT(worst_px, 0.05);
  wild_row("Calibrations", "equidistant (fisheye) cameras in cameras.yaml", "taken as radial-tangential, or refused",
           "rectified as OpenCV's fisheye does, worst of ten points " + std::to_string(worst_px) + " px off");
}

}  // namespace
}  // namespace rover::stereo
