#include <gtest/gtest.h>

#include <cmath>
#include <rover/ground_command_t.hpp>
#include <rover/image_t.hpp>
#include <rover/imu_t.hpp>
#include <rover/tick_t.hpp>
#include <rover/truth_t.hpp>

#include "common/bus/channels.hpp"
#include "common/bus/config.hpp"
#include "common/bus/convert.hpp"
#include "common/bus/event_log.hpp"
#include "common/bus/streams.hpp"
#include "common/bus/vehicle_config.hpp"
#include "data_set_fixture.hpp"

namespace rover::interchange {
namespace {

using Eigen::Vector3d;

TEST_F(ImportTest, KittiCalibrationAndTruthUseRoverAxes) {
  make_kitti();
  const StereoDataSet set = read_stereo_data_set(data_.string(), "", 10.0);
  EXPECT_EQ(set.layout, "KITTI");
  ASSERT_EQ(set.pairs.size(), 3U);
  EXPECT_EQ(set.rig.left.fy_px, 701.0);
  EXPECT_NEAR(set.rig.T_left_right.translation().x(), 0.5, 1e-12);
  EXPECT_EQ(set.pairs[2].since_first, 200'000);
  EXPECT_TRUE(set.pairs[1].T_map_body->translation().isApprox(Vector3d(1.0, 0.0, 0.0), 1e-12)) << "forward is x";
  EXPECT_TRUE(set.pairs[2].T_map_body->translation().isApprox(Vector3d(1.0, -1.0, 0.0), 1e-12)) << "right is -y";
}

TEST_F(ImportTest, KittiTimesComeFromFile) {
  make_kitti();
  write_text(data_ / "times.txt", "0.5\n0.604\n0.71\n");
  EXPECT_EQ(read_stereo_data_set(data_.string(), "", 10.0).pairs[1].since_first, 104'000);
}

TEST_F(ImportTest, EurocPairsHaveEqualTimeAndInterpolatedTruth) {
  make_euroc();
  const StereoDataSet set = read_stereo_data_set(data_.string(), "", 10.0);
  EXPECT_EQ(set.layout, "EuRoC");
  ASSERT_EQ(set.pairs.size(), 2U);
  EXPECT_EQ(set.skipped.at(kWithoutPartner), 1);
  EXPECT_EQ(set.pairs[1].since_first, 50'000);
  EXPECT_NEAR(set.rig.T_left_right.translation().x(), 0.11, 1e-12);
  EXPECT_EQ(set.rig.left.distortion[0], -0.28);
  EXPECT_EQ(set.rig.left.distortion[4], 0.0);
  // Between 4 and 6 m along the world's z; the camera is 0.1 m along -y of the sensors.
  EXPECT_TRUE(set.pairs[1].T_map_body->translation().isApprox(Vector3d(1.0, 1.9, 5.0), 1e-12));
  // The body is level; the camera looks along the sensors' z, which the truth turns.
  EXPECT_TRUE(set.pairs[0].T_map_body->linear().col(2).isApprox(Vector3d(0.0, 0.0, 1.0), 1e-9));
  const Eigen::Isometry3d T_map_left = *set.pairs[0].T_map_body * set.rig.T_body_left;
  EXPECT_TRUE(T_map_left.linear().col(2).isApprox(Vector3d(std::sqrt(0.5), 0.0, std::sqrt(0.5)), 1e-6));
}

// The camera looks along x of the body, before the body is level; level is what the truth says, 45 deg lower.
TEST_F(ImportTest, EurocImuIsInBodyAxesAndOnePerTick) {
  make_euroc();
  std::ofstream(data_ / "mav0/imu0/data.csv", std::ios::app) << "1025000000,0,0,nan,0,0,9.8\n";
  const StereoDataSet set = read_stereo_data_set(data_.string(), "", 10.0);
  ASSERT_EQ(set.imu.size(), 3U);
  EXPECT_EQ(set.skipped.at("IMU readings that are not a number"), 1);
  EXPECT_EQ(set.imu[0].since_first, -15'000);
  const Vector3d optical_axis = set.rig.T_body_left.linear().col(2);
  EXPECT_TRUE(set.imu[0].rate_radps.isApprox(0.1 * optical_axis, 1e-9));
  EXPECT_TRUE(set.imu[0].force_mps2.isApprox(9.8 * optical_axis, 1e-9));
  EXPECT_NEAR(optical_axis.x(), std::sqrt(0.5), 1e-6);
  import_data_set(options());
  std::vector<imu_t> ticks;
  for_each_event((out_ / "traverse.lcm").string(), [&](const LogEvent& event) {
    imu_t imu{};
    if (event.channel == channel::kImu && decode_message(event.data, event.size, imu)) ticks.push_back(imu);
  });
  ASSERT_EQ(ticks.size(), 2U) << "two readings in the tick of the first pair, one in the next";
  EXPECT_TRUE(Vector3d(ticks[0].delta_angle_rad).isApprox(0.2 * 0.02 * optical_axis, 1e-9));
  EXPECT_TRUE(Vector3d(ticks[1].delta_angle_rad).isApprox(0.4 * 0.02 * optical_axis, 1e-9));
  EXPECT_EQ(ticks[1].header.utime - ticks[0].header.utime, kTickUs);
}

TEST_F(ImportTest, KittiPosesOfTheOdometryDataSetAreFound) {
  make_kitti();
  const fs::path sequences = folder_.path() / "kitti" / "sequences";
  fs::create_directories(sequences.parent_path() / "poses");
  fs::rename(data_ / "poses.txt", sequences.parent_path() / "poses" / "06.txt");
  fs::create_directories(sequences);
  fs::rename(data_, sequences / "06");
  EXPECT_TRUE(read_stereo_data_set((sequences / "06").string(), "", 10.0).pairs[2].T_map_body.has_value());
}

TEST_F(ImportTest, LogContainsPairsTruthAndStartPose) {
  make_kitti();
  import_data_set(options());
  std::map<std::string, int> counts;
  Utime last_tick = 0;
  std::vector<std::uint8_t> grey;
  for_each_event((out_ / "traverse.lcm").string(), [&](const LogEvent& event) {
    ++counts[event.channel];
    tick_t tick{};
    image_t image{};
    ground_command_t command{};
    if (event.channel == channel::kTick && decode_message(event.data, event.size, tick)) last_tick = tick.header.utime;
    if (event.channel == channel::kLocCamRight && decode_message(event.data, event.size, image)) {
      grey.push_back(image.data.at(5));
      EXPECT_GE(image.header.utime, last_tick) << "before the tick that takes it";
      EXPECT_EQ(image.width, 64);
    }
    if (event.channel == channel::kGroundCommand && decode_message(event.data, event.size, command)) {
      EXPECT_EQ(command.kind, +ground_command_t::SET_START_POSE);
    }
  });
  EXPECT_EQ(grey, (std::vector<std::uint8_t>{20, 21, 22}));
  EXPECT_EQ(counts[channel::kLocCamLeft], 3);
  EXPECT_EQ(counts[channel::kTruth], 3);
  EXPECT_EQ(counts[channel::kGroundCommand], 1);
  // The services read the configuration: it is strict.
  const StereoRig rig = load_stereo_rig((out_ / "config").string(), "loccam");
  EXPECT_EQ(rig.width, 64);
  EXPECT_EQ(rig.left.fx_px, 700.0);
  EXPECT_TRUE(rig.T_body_left.isApprox(T_body_left_camera(), 1e-12));
}

TEST_F(ImportTest, ConfigurationKeepsRigPrecision) {
  make_euroc();
  import_data_set(options());
  const StereoRig rig = load_stereo_rig((out_ / "config").string(), "loccam");
  const StereoDataSet set = read_stereo_data_set(data_.string(), "", 10.0);
  EXPECT_TRUE(rig.T_left_right.isApprox(set.rig.T_left_right, 1e-12));
  EXPECT_TRUE(rig.T_body_left.isApprox(set.rig.T_body_left, 1e-9));
  EXPECT_EQ(rig.right.distortion, set.rig.right.distortion);
}

TEST_F(ImportTest, BadInputPrintsOneLineAndLeavesNothing) {
  expect_refused("no such folder");
  fs::create_directories(data_);
  expect_refused("neither KITTI's odometry layout");
  make_kitti();
  write_text(data_ / "calib.txt", "P0: 700 0 32 0 0 701 24 0 0 0 1\nP1: 1\n");
  expect_refused("calib.txt:1: 11 columns; the twelve numbers");
  make_kitti();
  write_text(data_ / "calib.txt", "P0: 700 0 32 0 0 701 24 0 0 0 1 0\n");
  expect_refused("two cameras, P0 and P1");
  make_kitti();
  write_text(data_ / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  expect_refused("poses.txt: 1 rows for the images 0 to 2");
  make_kitti();
  write_text(data_ / "image_1" / "000001.png", "no picture");
  expect_refused("000001.png: not a readable image");
  write_picture(data_ / "image_1" / "000001.png", 1, 32, 48);
  expect_refused("the first picture has 64 x 48");
}

TEST_F(ImportTest, BadEurocInputPrintsOneLineAndLeavesNothing) {
  make_euroc();
  write_text(data_ / "mav0/cam1/data.csv", "#timestamp [ns],filename\nsoon,a.png\n");
  expect_refused("cam1/data.csv:2: 'soon' is not a time");
  make_euroc();
  write_text(data_ / "mav0/cam0/sensor.yaml", "camera_model: omni\n");
  expect_refused("camera_model");
  make_euroc();
  write_text(data_ / "mav0/imu0/data.csv", "985000000,0,0,0.1\n");
  expect_refused("imu0/data.csv:1: too few columns");
  write_text(data_ / "mav0/imu0/data.csv", "985000,0,0,0.1,0,0,9.8\n");
  expect_refused("imu0/data.csv: no reading is within the time of the images");
}

TEST_F(ImportTest, RefusesImagesLargerThanAMessage) {
  make_kitti();
  for (const char* camera : {"image_0", "image_1"})
    for (int i = 0; i < 3; ++i) write_picture(data_ / camera / ("00000" + std::to_string(i) + ".png"), 9, 1000, 600);
  expect_refused("600000 px, a message holds at most 500000");
}

TEST_F(ImportTest, OverwritesNothing) {
  make_kitti();
  write_text(out_ / "mine", "mine");
  EXPECT_NE(refusal(options()).find("already exists"), std::string::npos);
  EXPECT_EQ(std::distance(fs::directory_iterator(out_), fs::directory_iterator()), 1);
}

}  // namespace
}  // namespace rover::interchange
