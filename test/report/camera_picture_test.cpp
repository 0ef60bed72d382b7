#include "tools/report/camera_picture.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <rover/disparity_t.hpp>
#include <rover/image_t.hpp>

#include "../common/temp_folder.hpp"
#include "common/bus/channels.hpp"
#include "message_log.hpp"
#include "tools/report/camera_reader.hpp"

namespace rover::report {
namespace {

constexpr double kOriginHeight = 0.62;

// 0.4 m above and 0.5 m ahead of the body origin, looking straight ahead.
CameraView level_camera() {
  CameraView view{400.0, 256.0, 192.0, Eigen::Isometry3d::Identity()};
  view.T_body_cam.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  view.T_body_cam.translation() = Eigen::Vector3d(0.5, 0.0, 0.4);
  return view;
}

TEST(CameraPicture, GroundCellProjectsToCorrectPixel) {
  const auto ahead = pixel_of(level_camera(), {{2.5, 0.0}, false}, kOriginHeight);
  ASSERT_TRUE(ahead);
  EXPECT_NEAR(ahead->x(), 256.0, 1e-9);
  EXPECT_NEAR(ahead->y(), 192.0 + 400.0 * 1.02 / 2.0, 1e-9);
  const auto left = pixel_of(level_camera(), {{2.5, 0.5}, false}, kOriginHeight);
  ASSERT_TRUE(left);
  EXPECT_NEAR(left->x(), 256.0 - 400.0 * 0.5 / 2.0, 1e-9);
  EXPECT_FALSE(pixel_of(level_camera(), {{-1.0, 0.0}, false}, kOriginHeight)) << "behind the camera";
}

HazardMap map_at(double t_s, bool with_cells) {
  HazardMap map;
  map.t_s = t_s;
  map.released_s = t_s + 0.3;
  if (with_cells) map.cells.push_back({{4.5, 0.0}, false});
  return map;
}

TEST(CameraPicture, ExposureOfIncidentIsNewestWithCells) {
  RunRecord run;
  run.hazards = {map_at(8.0, true), map_at(9.0, true), map_at(9.4, false), map_at(9.8, true)};
  EXPECT_EQ(exposure_behind(run, 10.0), 9.0) << "that of 9.8 s was not known yet";
  EXPECT_EQ(exposure_behind(run, 10.2), 9.8);
  run.hazards = {map_at(2.0, true), map_at(9.0, false)};
  EXPECT_EQ(exposure_behind(run, 10.0), 9.0) << "cells of long ago are not the cause";
  EXPECT_TRUE(std::isnan(exposure_behind(RunRecord{}, 10.0)));
}

image_t image_of(std::uint8_t grey) {
  image_t image{};
  image.width = 4;
  image.height = 2;
  image.size = 8;
  image.data.assign(8, grey);
  return image;
}

class CameraReader : public testing::Test {
 protected:
  CameraReader() {
    MessageLog log(path_);
    for (const Utime t : {Utime{400'000}, Utime{800'000}})
      log.put(channel::kLocCamLeft, image_of(static_cast<std::uint8_t>(t / 10'000)), t, "rover_simulator");
    log.put(channel::kLocCamRectLeft, image_of(200), 800'000, "stereo");
    disparity_t disparity{};
    disparity.focal_px = 400.0;
    disparity.quat_body_cam_wxyz[0] = 1.0;
    log.put(channel::kDisparity, disparity, 800'000, "stereo");
  }
  testing_support::TempFolder folder_;
  std::string path_ = folder_.file("log.lcm");
};

TEST_F(CameraReader, PrefersRectifiedImage) {
  const auto pictures = read_camera_pictures(choose_run(path_), {0.8, 0.4, 1.2, kNaN});
  ASSERT_EQ(pictures.size(), 4U);
  ASSERT_TRUE(pictures[0] && pictures[1]);
  EXPECT_EQ(pictures[0]->grey.front(), 200);
  EXPECT_NEAR(pictures[0]->t_s, 0.8, 1e-9);
  ASSERT_TRUE(pictures[0]->rectified);
  EXPECT_EQ(pictures[0]->rectified->focal_px, 400.0);
  EXPECT_EQ(pictures[1]->grey.front(), 40);
  EXPECT_FALSE(pictures[1]->rectified) << "the lens bends what it sees";
  EXPECT_FALSE(pictures[2]) << "not in the log";
  EXPECT_FALSE(pictures[3]);
}

TEST(CameraPicture, TheDrawingHoldsImageAndCells) {
  CameraPicture picture{9.0, 512, 384, std::vector<std::uint8_t>(512 * 384, 90), level_camera()};
  RunRecord run;
  run.hazards = {map_at(9.0, true)};
  const std::string with = draw_camera(picture, run, kOriginHeight);
  EXPECT_THAT(with, testing::HasSubstr("data:image/jpeg;base64,"));
  EXPECT_THAT(with, testing::HasSubstr("<circle"));
  run.hazards = {map_at(8.6, true)};
  EXPECT_THAT(draw_camera(picture, run, kOriginHeight), testing::Not(testing::HasSubstr("<circle")))
      << "cells of another exposure";
}

}  // namespace
}  // namespace rover::report
