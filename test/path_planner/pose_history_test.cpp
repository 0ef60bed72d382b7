// Poses of the last seconds, at the exposures of frames.
#include "path_planner/pose_history.hpp"

#include <gtest/gtest.h>

namespace rover::planning {
namespace {

PoseSample sample_at(Utime utime, const Pose2& pose) {
  PoseSample sample;
  sample.utime = utime;
  sample.T_odom_ground = from_planar(pose);
  return sample;
}

TEST(PoseHistory, InterpolatesBetweenPoses) {
  PoseHistory history;
  history.add(sample_at(100'000, {1.0, 0.0, 0.0}));
  history.add(sample_at(200'000, {2.0, 0.0, 0.4}));
  const auto pose = history.at(125'000);
  ASSERT_TRUE(pose);
  EXPECT_NEAR(planar(*pose).x_m, 1.25, 1e-9);
  EXPECT_NEAR(planar(*pose).yaw_rad, 0.1, 1e-9);
  EXPECT_NEAR(planar(*history.at(200'000)).x_m, 2.0, 1e-9);
}

TEST(PoseHistory, KnowsNoPoseOutsideOfWhatItKeeps) {
  PoseHistory history;
  EXPECT_FALSE(history.at(0));
  for (int i = 0; i <= 300; ++i) history.add(sample_at(i * 100'000, {0.1 * i, 0.0, 0.0}));
  EXPECT_FALSE(history.at(30'000'001));
  EXPECT_TRUE(history.at(10'050'000));
  EXPECT_FALSE(history.at(9'900'000)) << "longer ago than 20 s";
  history.clear();
  EXPECT_TRUE(history.empty());
  EXPECT_FALSE(history.at(10'050'000));
}

TEST(PoseHistory, DropsPosesThatComeTooLate) {
  PoseHistory history;
  history.add(sample_at(200'000, {2.0, 0.0, 0.0}));
  history.add(sample_at(100'000, {1.0, 0.0, 0.0}));
  history.add(sample_at(200'000, {5.0, 0.0, 0.0}));
  EXPECT_EQ(history.newest().T_odom_ground.translation().x(), 2.0);
  EXPECT_FALSE(history.at(150'000));
}

}  // namespace
}  // namespace rover::planning
