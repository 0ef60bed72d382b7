#include "stereo/node.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <rover/disparity_t.hpp>

#include "common/bus/convert.hpp"
#include "test/stereo/one_node_world.hpp"
#include "test/stereo/synthetic_world.hpp"

namespace rover::stereo {
namespace {

const std::string kConfig = std::string(ROVER_SOURCE_DIR) + "/config";

image_t message_of(const GrayImage& image) {
  image_t message{};
  image_to(image, message);
  return message;
}

class StereoNodeTest : public testing::Test {
 protected:
  StereoNodeTest() : world_("stereo"), stereo_(make_stereo(world_.node(), kConfig)) {
    const synthetic::RawPair pair = synthetic::render({}, synthetic::loccam_rig(), 1.0, 5);
    left_ = message_of(pair.left);
    right_ = message_of(pair.right);
    left_.exposure_s = 0.004F;
    right_.exposure_s = 0.005F;
    world_.record(channel::kDisparity, disparities_);
    world_.record(channel::kLocCamRectLeft, rect_left_);
    world_.record(channel::kLocCamRectRight, rect_right_);
  }

  test::OneNodeWorld world_;
  std::shared_ptr<StereoNode> stereo_;
  image_t left_, right_;
  std::vector<disparity_t> disparities_;
  std::vector<image_t> rect_left_, rect_right_;
};

TEST_F(StereoNodeTest, PairGivesDisparityWithExposureTimeAfterLatency) {
  world_.send(channel::kLocCamLeft, left_, 20'000);
  world_.send(channel::kLocCamRight, right_, 20'000);
  world_.tick(40'000);
  world_.tick(60'000);
  ASSERT_EQ(disparities_.size(), 1u);
  const disparity_t& d = disparities_[0];
  EXPECT_EQ(d.header.utime, 20'000);
  EXPECT_EQ(d.header.release_utime, 40'000 + 120'000);
  EXPECT_EQ(d.width, 512);
  EXPECT_EQ(d.height, 384);
  EXPECT_NEAR(d.baseline_m, 0.12, 1e-4);
  EXPECT_GT(d.valid_fraction, 0.85f);
  // Same position as the left camera, pitched down 33 deg within the mounting alignment.
  EXPECT_NEAR(d.position_body_cam_m[0], 0.527, 1e-9);
  const StereoCamera camera = camera_from(d);
  EXPECT_NEAR(std::asin(-(camera.T_body_cam.linear() * Eigen::Vector3d::UnitZ()).z()), to_rad(33.0), to_rad(0.5));
  ASSERT_EQ(rect_left_.size(), 1u);
  ASSERT_EQ(rect_right_.size(), 1u);
  EXPECT_EQ(rect_left_[0].header.utime, 20'000);
  EXPECT_EQ(rect_left_[0].exposure_s, 0.004F);
  EXPECT_EQ(rect_right_[0].exposure_s, 0.005F);
}

TEST_F(StereoNodeTest, UnpairedImagesAreCountedAndDropped) {
  world_.send(channel::kLocCamLeft, left_, 20'000);
  world_.tick(20'000);
  world_.send(channel::kLocCamLeft, left_, 420'000);
  world_.send(channel::kLocCamRight, right_, 420'000);
  world_.tick(420'000);
  world_.send(channel::kLocCamRight, right_, 820'000);
  world_.tick(820'000);
  world_.send(channel::kLocCamLeft, left_, 1'220'000);
  world_.send(channel::kLocCamRight, right_, 1'220'000);
  world_.tick(1'220'000);
  world_.tick(1'400'000);
  ASSERT_EQ(disparities_.size(), 2u);
  EXPECT_EQ(world_.malformed(channel::kLocCamLeft), 1);
  EXPECT_EQ(world_.malformed(channel::kLocCamRight), 1);
}

TEST_F(StereoNodeTest, InconsistentImagesAreCountedAndDropped) {
  image_t small = message_of(GrayImage(256, 192, 100));
  image_t lying = left_;
  lying.height = 383;
  image_t colour = left_;
  colour.encoding = 7;
  Utime t = 100'000;
  for (const image_t& bad : {small, lying, colour}) {
    world_.send(channel::kLocCamLeft, bad, t);
    world_.send(channel::kLocCamRight, right_, t);
    world_.tick(t);
    t += 400'000;
  }
  world_.tick(1'400'000);  // with a heartbeat
  EXPECT_TRUE(disparities_.empty());
  EXPECT_EQ(world_.malformed(channel::kLocCamLeft), 3);
}

TEST_F(StereoNodeTest, BlankPairIsPublishedAsAllInvalid) {
  world_.send(channel::kLocCamLeft, message_of(GrayImage(512, 384, 30)), 20'000);
  world_.send(channel::kLocCamRight, message_of(GrayImage(512, 384, 30)), 20'000);
  world_.tick(20'000);
  world_.tick(40'000);
  ASSERT_EQ(disparities_.size(), 1u);
  EXPECT_EQ(disparities_[0].valid_fraction, 0.0f);
  EXPECT_TRUE(std::all_of(disparities_[0].disparity_px16.begin(), disparities_[0].disparity_px16.end(),
                          [](int d) { return d == disparity_t::INVALID; }));
}

// Odometry on a frozen image would report a stationary rover.
TEST_F(StereoNodeTest, FrozenCameraGivesAllInvalidDisparityWithoutImages) {
  Utime t = 20'000;
  const auto send = [&](bool left_moves, bool right_moves) {
    left_.data[1000] ^= static_cast<std::uint8_t>(left_moves);
    right_.data[1000] ^= static_cast<std::uint8_t>(right_moves);
    world_.send(channel::kLocCamLeft, left_, t);
    world_.send(channel::kLocCamRight, right_, t);
    world_.tick(t);
    world_.tick(t + 20'000);
    t += 400'000;
    return disparities_.back().valid_fraction;
  };
  EXPECT_GT(send(true, true), 0.85F);
  EXPECT_EQ(send(false, false), 0.0F);
  EXPECT_EQ(send(true, false), 0.0F);
  EXPECT_EQ(send(false, true), 0.0F);
  EXPECT_EQ(rect_left_.size(), 1u);
  EXPECT_EQ(rect_right_.size(), 1u);
  EXPECT_GT(send(true, true), 0.85F);
  EXPECT_EQ(disparities_.size(), 5u);
  EXPECT_EQ(rect_left_.size(), 2u);
  EXPECT_EQ(rect_right_.size(), 2u);
}

TEST(StereoConfigTest, UnknownKeyOrBadRangeStopsStartUp) {
  const std::filesystem::path dir = std::filesystem::path(testing::TempDir()) / "stereo_config";
  std::filesystem::create_directories(dir);
  for (const char* file : {"vehicle.yaml", "cameras.yaml"})
    std::filesystem::copy_file(kConfig + "/" + file, dir / file, std::filesystem::copy_options::overwrite_existing);
  for (const char* bad : {"matcher: {block: 11}", "matcher: {block_px: 10}", "matcher: {residual_count_px: 60}",
                          "matcher: {block_px: 33}", "matcher: {}\nlatency: 0.1"}) {
    std::ofstream(dir / "stereo.yaml") << bad << "\n";
    EXPECT_THROW(load_config(dir.string()), ConfigError) << bad;
  }
}

}  // namespace
}  // namespace rover::stereo
