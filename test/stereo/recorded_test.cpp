// Stereo on recorded images: a desert field trial on Earth and a Curiosity pair from Mars.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "common/stereo/stereo.hpp"

namespace rover::stereo {
namespace {

const std::string kData = std::string(ROVER_SOURCE_DIR) + "/test/data/";

GrayImage load(const std::string& file) {
  const cv::Mat pixels = cv::imread(kData + file, cv::IMREAD_GRAYSCALE);
  GrayImage image(pixels.cols, pixels.rows);
  std::copy(pixels.begin<std::uint8_t>(), pixels.end<std::uint8_t>(), image.data.begin());
  return image;
}

// Matcher for an already rectified pair, search range 0 to 63 px.
Disparity match(const std::string& left, const std::string& right, const PinholeCamera& camera, double baseline_m) {
  cv::setNumThreads(1);
  const GrayImage l = load(left), r = load(right);
  StereoRig rig;
  rig.width = l.width;
  rig.height = l.height;
  rig.left = rig.right = camera;
  rig.T_left_right.translation().x() = baseline_m;
  StereoConfig config;
  config.ground_reference = false;
  config.matcher.residual_min_px = 0;
  return Stereo(config, rig, 0.0).step(l, r).value().disparity;
}

double quantile(std::vector<double>& values, double q) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

TEST(RecordedStereoTest, MinnieMatchesPublishedDisparity) {
  const Disparity ours = match("minnie/MinnieRectLeftDeg3.png", "minnie/MinnieRectRightDeg3.png",
                               {339.532, 339.532, 318.834, 205.771, {}}, 0.2675);
  const cv::Mat theirs = cv::imread(kData + "minnie/MinnieDisparityDeg3.png", cv::IMREAD_UNCHANGED);
  ASSERT_EQ(theirs.type(), CV_16U);
  std::vector<double> difference;
  int published = 0;
  for (int v = 0; v < ours.height; ++v)
    for (int u = 0; u < ours.width; ++u) {
      if (theirs.at<std::uint16_t>(v, u) == 0) continue;
      ++published;
      if (ours.valid(u, v)) difference.push_back(std::abs(ours.px(u, v) - theirs.at<std::uint16_t>(v, u) / 16.0));
    }
  // The published disparity rounds up by 0.03 px on average, with pixel locking.
  EXPECT_GT(static_cast<double>(difference.size()), 0.95 * published);
  EXPECT_LT(quantile(difference, 0.5), 0.2);
  EXPECT_LT(quantile(difference, 0.9), 0.5);
  EXPECT_LT(quantile(difference, 0.98), 1.5);
}

TEST(RecordedStereoTest, MarsGroundHasDisparityAndSkyHasNone) {
  const Disparity disparity =
      match("msl_navcam/rect_left.png", "msl_navcam/rect_right.png", {1224.7, 1224.8, 507.2, 502.1, {}}, 0.424);
  int sky = 0, ground = 0, measured = 0;
  std::vector<double> values, top, bottom;
  for (int v = 0; v < 1024; ++v)
    for (int u = 100; u < 1024; ++u) {
      if (v < 400) sky += disparity.valid(u, v);
      if (v < 720) continue;
      ++ground;
      if (!disparity.valid(u, v)) continue;
      ++measured;
      values.push_back(disparity.px(u, v));
      if (v < 780) top.push_back(values.back());
      if (v > 960) bottom.push_back(values.back());
    }
  EXPECT_LT(sky, 400);  // of 370 000
  // Rows are misaligned by 1.3 px (median), and JPEG-smoothed sand fails the uniqueness test.
  EXPECT_GT(measured, 0.35 * ground);
  EXPECT_GT(quantile(values, 0.02), 13.0);
  EXPECT_LT(quantile(values, 0.98), 42.0);
  EXPECT_GT(quantile(bottom, 0.5), quantile(top, 0.5) + 3.0);
}

}  // namespace
}  // namespace rover::stereo
