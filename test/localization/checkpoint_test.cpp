#include "localization/checkpoint.hpp"

#include <gtest/gtest.h>

namespace rover::loc {
namespace {

Checkpoint sample() {
  Checkpoint c;
  c.utime = 123'456'780'000;
  c.T_odom_body = make_pose(rotation_from_rpy(0.1, -0.2, 2.0), {1.0, 2.0, 3.0});
  c.T_map_odom = make_pose(rotation_from_rpy(0.0, 0.0, -1.0), {100.0, 50.0, 4.0});
  c.map_known = true;
  c.gyro_bias_radps = {1e-5, 2e-5, -3e-5};
  c.P = ErrorCov::Identity() * 0.25;
  c.gravity_mps2 = 3.71;
  c.travelled_m = 42.5;
  c.newest_visual_utime = 1'234'567;
  c.drive_angle_rad = {1, 2, 3, 4, 5, 6};
  c.traction = 0.6;
  c.side_slip = -0.05;
  c.smoothing_offset_m = {0.01, -0.02, 0.03};
  c.smoothing_offset_rad = {0.001, 0.002, -0.003};
  c.consecutive_conflicts = 7;
  c.imu_healthy_utime = 123'456'000'000;
  c.dead_reckoned_m = 1.5;
  return c;
}

TEST(Checkpoint, RoundTrip) {
  const auto back = from_bytes(to_bytes(sample()));
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(back->utime, sample().utime);
  EXPECT_TRUE(back->T_odom_body.isApprox(sample().T_odom_body, 1e-14));
  EXPECT_TRUE(back->T_map_odom.isApprox(sample().T_map_odom, 1e-14));
  EXPECT_TRUE(back->map_known);
  EXPECT_EQ(back->gyro_bias_radps, sample().gyro_bias_radps);
  EXPECT_EQ(back->P, sample().P);
  EXPECT_EQ(back->gravity_mps2, 3.71);
  EXPECT_EQ(back->travelled_m, 42.5);
  EXPECT_EQ(back->newest_visual_utime, 1'234'567);
  EXPECT_EQ(back->drive_angle_rad, sample().drive_angle_rad);
  EXPECT_EQ(back->traction, 0.6);
  EXPECT_EQ(back->side_slip, -0.05);
  EXPECT_EQ(back->smoothing_offset_m, sample().smoothing_offset_m);
  EXPECT_EQ(back->smoothing_offset_rad, sample().smoothing_offset_rad);
  EXPECT_EQ(back->consecutive_conflicts, 7);
  EXPECT_EQ(back->imu_healthy_utime, 123'456'000'000);
  EXPECT_EQ(back->dead_reckoned_m, 1.5);
}

TEST(Checkpoint, RejectsInvalidBytes) {
  auto bytes = to_bytes(sample());
  bytes.pop_back();
  EXPECT_FALSE(from_bytes(bytes).has_value());
  EXPECT_FALSE(from_bytes({}).has_value());
  auto old = to_bytes(sample());
  old[7] ^= 0x10;  // the version
  EXPECT_FALSE(from_bytes(old).has_value());
  Checkpoint bad = sample();
  bad.T_odom_body.translation().x() = kNaN;
  EXPECT_FALSE(from_bytes(to_bytes(bad)).has_value());
  Checkpoint early = sample();
  early.newest_visual_utime = early.utime + 1;
  EXPECT_FALSE(from_bytes(to_bytes(early)).has_value()) << "future odometry would look fresh";
  Checkpoint unknown_traction = sample();
  unknown_traction.traction = kNaN;
  EXPECT_FALSE(from_bytes(to_bytes(unknown_traction)).has_value());
}

}  // namespace
}  // namespace rover::loc
