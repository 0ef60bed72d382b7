#include "tools/report/track.hpp"

#include <gtest/gtest.h>

#include "known_run.hpp"

namespace rover::report {
namespace {

TEST(TrueTrack, VibrationDoesNotAddDistance) {
  std::vector<TruthSample> truth(1000);
  for (size_t i = 0; i < truth.size(); ++i) {
    truth[i].t_s = 0.02 * static_cast<double>(i);
    truth[i].T_map_body = pose_at(i % 2 == 0 ? 0.0 : 0.005, 0.0);
  }
  EXPECT_LE(TrueTrack(truth).distance_m(100.0), 0.005);
}

TEST(TrueTrack, InterpolatesAndClampsAtEnds) {
  const TrueTrack track(straight_run(2.0).truth);
  EXPECT_NEAR(track.at(15.25).translation().x(), 1.025, 1e-12);
  EXPECT_EQ(track.at(-5.0).translation().x(), 0.0);
  EXPECT_NEAR(track.at(1e6).translation().x(), 2.0, 1e-12);
  EXPECT_NEAR(track.distance_m(25.0), 2.0, 1e-9);
}

TEST(DriveWindow, FromDrivingToTheGoal) {
  RunRecord run = straight_run(2.0);
  EXPECT_DOUBLE_EQ(drive_window(run).begin_s, 5.0);
  EXPECT_DOUBLE_EQ(drive_window(run).end_s, 25.0);
  run.states.clear();
  EXPECT_DOUBLE_EQ(drive_window(run).begin_s, 0.0);
  EXPECT_DOUBLE_EQ(drive_window(run).end_s, 30.0);
}

TEST(PlaneMotions, InverseUndoesCompose) {
  const Pose2 a{3.0, -2.0, 2.5};
  const Pose2 both = compose(a, inverse(a));
  EXPECT_NEAR(both.x_m, 0.0, 1e-12);
  EXPECT_NEAR(both.y_m, 0.0, 1e-12);
  EXPECT_NEAR(both.yaw_rad, 0.0, 1e-12);
}

// Odometry without error has no drift, whatever its frame.
TEST(Drift, DoesNotDependOnTheFrameOfTheOdometry) {
  RunRecord run = straight_run(10.0);
  const Eigen::Isometry3d T_odom_map = pose_at(-40.0, 17.0, 2.2);
  for (PoseSample& pose : run.poses) pose.T_odom_body = T_odom_map * pose.T_odom_body;
  const TrueTrack truth(run.truth);
  for (const DriftSample& sample : odometry_drift(run, truth, drive_window(run))) {
    EXPECT_NEAR(sample.error_x_m, 0.0, 1e-9);
    EXPECT_NEAR(sample.error_y_m, 0.0, 1e-9);
  }
}

TEST(Drift, IsTheErrorSinceTheStart) {
  RunRecord run = straight_run(10.0);
  // The error of 3 m at the start does not count; the scale error of 2 % does.
  for (PoseSample& pose : run.poses)
    pose.T_odom_body.translation().x() = 3.0 + 1.02 * pose.T_odom_body.translation().x();
  const TrueTrack truth(run.truth);
  const std::vector<DriftSample> drift = odometry_drift(run, truth, drive_window(run));
  EXPECT_NEAR(drift.front().error_x_m, 0.0, 1e-9);
  EXPECT_NEAR(drift.back().error_x_m, 0.2, 1e-9);
  EXPECT_NEAR(drift.back().error_y_m, 0.0, 1e-9);
  EXPECT_NEAR(figures(run).odometry_drift_percent, 2.0, 0.01);
}

}  // namespace
}  // namespace rover::report
