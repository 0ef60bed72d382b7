// Block matcher against OpenCV's StereoBM, which uses the same costs and tests. Known differences: StereoBM rounds the
// sub-pixel value up to 1/16 px, and its left-right check accepts agreement with either neighbouring right pixel.
#include "common/stereo/block_matcher.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <random>
#include <string>

#include "common/stereo/rectifier.hpp"
#include "test/stereo/synthetic_world.hpp"

namespace rover::stereo {
namespace {

struct PaddedPair {
  std::string name;
  MatcherConfig config;
  cv::Mat left, right, right_valid;
};

PaddedPair rendered() {
  synthetic::World world;
  world.rocks = {{1.5, 0.2, 0.25, 0.2}, {2.0, -0.3, 0.3, 0.3, true}, {1.2, -0.2, 0.1, 0.1, false, true}};
  const StereoRig rig = synthetic::loccam_rig();
  const synthetic::RawPair raw = synthetic::render(world, rig, 1.0, 5);
  const MatcherConfig config;
  const Rectifier rectifier(rig, BlockMatcher::pad(config), 0.62);
  const RectifiedPair pair = rectifier.rectify(raw.left, raw.right);
  return {"rendered", config, pair.match_left, pair.match_right, rectifier.match_right_valid()};
}

PaddedPair padded(const std::string& name, const MatcherConfig& config, const cv::Mat& left, const cv::Mat& right) {
  const MatchPad pad = BlockMatcher::pad(config);
  PaddedPair pair{name, config, {}, {}, {}};
  cv::copyMakeBorder(left, pair.left, pad.rows, pad.rows, pad.left, pad.right, cv::BORDER_REPLICATE);
  cv::copyMakeBorder(right, pair.right, pad.rows, pad.rows, pad.left, pad.right, cv::BORDER_REPLICATE);
  pair.right_valid = cv::Mat(pair.right.size(), CV_8U, cv::Scalar(255));
  return pair;
}

PaddedPair recorded(const std::string& left, const std::string& right) {
  const std::string data = ROVER_SOURCE_DIR "/test/data/";
  MatcherConfig config;
  config.residual_min_px = 0;
  return padded(left, config, cv::imread(data + left, cv::IMREAD_GRAYSCALE),
                cv::imread(data + right, cv::IMREAD_GRAYSCALE));
}

// Black and white noise with a negated right image: maximum costs.
PaddedPair negative() {
  std::mt19937 random(7);
  cv::Mat left(60, 150, CV_8U);
  for (auto& pixel : cv::Mat_<std::uint8_t>(left)) pixel = random() % 2 ? 255 : 0;
  MatcherConfig config;
  config.residual_min_px = -10;
  config.residual_count_px = 16;
  config.block_px = 21;
  config.prefilter_cap = 63;
  config.uniqueness_percent = 1;
  return padded("negative", config, left, 255 - left);
}

std::vector<PaddedPair> pairs() {
  return {rendered(), recorded("minnie/MinnieRectLeftDeg3.png", "minnie/MinnieRectRightDeg3.png"),
          recorded("msl_navcam/rect_left.png", "msl_navcam/rect_right.png")};
}

std::vector<PaddedPair> pairs_and_negative() {
  std::vector<PaddedPair> all = pairs();
  all.push_back(negative());
  return all;
}

cv::Mat without_pad(const cv::Mat& image, const MatcherConfig& config) {
  const MatchPad pad = BlockMatcher::pad(config);
  return image(cv::Range(pad.rows, image.rows - pad.rows), cv::Range(pad.left, image.cols - pad.right));
}

cv::Mat opencv_residual(const PaddedPair& pair) {
  const MatcherConfig& config = pair.config;
  const cv::Ptr<cv::StereoBM> matcher = cv::StereoBM::create(config.residual_count_px, config.block_px);
  matcher->setMinDisparity(config.residual_min_px);
  matcher->setPreFilterType(cv::StereoBM::PREFILTER_XSOBEL);
  matcher->setPreFilterCap(config.prefilter_cap);
  matcher->setTextureThreshold(config.texture_threshold);
  matcher->setUniquenessRatio(config.uniqueness_percent);
  matcher->setDisp12MaxDiff(config.left_right_max_px);
  matcher->setSpeckleWindowSize(config.speckle_px);
  matcher->setSpeckleRange(config.speckle_step_px16);
  cv::Mat residual;
  matcher->compute(pair.left, pair.right, residual);
  residual.setTo(BlockMatcher::kInvalid, residual < 16 * config.residual_min_px);
  return without_pad(residual, config);
}

cv::Mat own_residual(const PaddedPair& pair, bool avx2 = BlockMatcher::cpu_has_avx2()) {
  return BlockMatcher(pair.config, avx2).match(pair.left, pair.right, pair.right_valid);
}

// Fraction of pixels that are invalid in both or equal up to StereoBM's rounding.
double agreement(const cv::Mat& own, const cv::Mat& opencv) {
  int agree = 0;
  for (int v = 0; v < own.rows; ++v)
    for (int u = 0; u < own.cols; ++u) {
      const int up = opencv.at<std::int16_t>(v, u) - own.at<std::int16_t>(v, u);
      agree += up == 0 || up == 1;
    }
  return agree / static_cast<double>(own.total());
}

double valid_fraction(const cv::Mat& residual) {
  return cv::countNonZero(residual != BlockMatcher::kInvalid) / static_cast<double>(residual.total());
}

TEST(BlockMatcherTest, CostsTextureUniquenessAndSubpixelMatchStereoBM) {
  for (PaddedPair& pair : pairs_and_negative()) {
    pair.config.left_right_max_px = pair.config.residual_count_px;
    pair.config.speckle_px = 0;
    pair.right_valid.setTo(255);
    const cv::Mat own = own_residual(pair);
    EXPECT_EQ(agreement(own, opencv_residual(pair)), 1.0) << pair.name;
    EXPECT_GT(valid_fraction(own), 0.3) << pair.name;
  }
}

TEST(BlockMatcherTest, LeftRightCheckDiffersFromStereoBMForFewPixels) {
  for (PaddedPair& pair : pairs()) {
    pair.config.speckle_px = 0;
    pair.right_valid.setTo(255);
    EXPECT_GT(agreement(own_residual(pair), opencv_residual(pair)), 0.998) << pair.name;
  }
}

// Regions connect by steps of 2/16 px, so rounding can join or split them.
TEST(BlockMatcherTest, SpeckleFilterDiffersFromStereoBMAtRegionEdges) {
  for (PaddedPair& pair : pairs()) {
    pair.right_valid.setTo(255);
    EXPECT_GT(agreement(own_residual(pair), opencv_residual(pair)), 0.985) << pair.name;
  }
}

TEST(BlockMatcherTest, Avx2AndBaselineAreByteIdentical) {
  if (!BlockMatcher::cpu_has_avx2()) GTEST_SKIP() << "no AVX2";
  for (const PaddedPair& pair : pairs_and_negative())
    EXPECT_EQ(cv::norm(own_residual(pair, true), own_residual(pair, false), cv::NORM_INF), 0.0) << pair.name;
}

TEST(BlockMatcherTest, MatchWithMaskedRightPixelIsInvalid) {
  PaddedPair pair = recorded("minnie/MinnieRectLeftDeg3.png", "minnie/MinnieRectRightDeg3.png");
  pair.config.speckle_px = 0;
  const cv::Mat all = own_residual(pair);
  const MatchPad pad = BlockMatcher::pad(pair.config);
  const int seen_from = 320;
  pair.right_valid.colRange(0, pad.left + seen_from).setTo(0);
  const cv::Mat some = own_residual(pair);
  for (int v = 0; v < all.rows; ++v)
    for (int u = 0; u < all.cols; ++u) {
      const std::int16_t r = all.at<std::int16_t>(v, u);
      const double x = u - r / 16.0;
      if (r != BlockMatcher::kInvalid && std::abs(x - seen_from) < 1.0) continue;  // the match is rounded to a pixel
      const bool kept = r == BlockMatcher::kInvalid || x > seen_from;
      ASSERT_EQ(some.at<std::int16_t>(v, u), kept ? r : BlockMatcher::kInvalid) << u << ' ' << v;
    }
}

}  // namespace
}  // namespace rover::stereo
