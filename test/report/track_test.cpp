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

PathRecord path_at(double t_s, std::int64_t id, Points points) {
  PathRecord path;
  path.t_s = t_s;
  path.id = id;
  path.points = std::move(points);
  return path;
}

TEST(FollowedPaths, AreUnderWayBetweenTheFirstDrivingAndTheGoal) {
  RunRecord run = straight_run(10.0);
  const Points aside{{0.0, 0.0}, {0.0, 5.0}}, other{{3.0, 0.0}, {10.0, 2.0}};
  run.global_paths.insert(run.global_paths.begin(), path_at(0.0, 7, aside));
  run.global_paths.push_back(path_at(105.5, 8, aside));
  std::vector<PathRecord> paths = followed_paths(run, drive_window(run));
  ASSERT_EQ(paths.size(), 1u);
  EXPECT_EQ(paths[0].id, 1);
  run.global_paths.insert(run.global_paths.end() - 1, path_at(40.0, 9, other));
  paths = followed_paths(run, drive_window(run));
  ASSERT_EQ(paths.size(), 2u);
  EXPECT_EQ(paths[1].id, 9);
}

TEST(FollowedPaths, AZoneEditThatSendsTheRestIsNoOtherPath) {
  RunRecord run = straight_run(10.0);
  const Points bent{{0.0, 0.0}, {4.0, 0.0}, {7.0, 1.0}, {10.0, 0.0}};
  run.global_paths = {path_at(0.0, 1, bent), path_at(20.0, 2, bent),
                      path_at(60.0, 3, {{5.5, 0.2}, {7.0, 1.0}, {10.0, 0.0}})};
  run.global_paths.back().zones = {{"cliff", false, {{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}}}};
  std::vector<PathRecord> paths = followed_paths(run, drive_window(run));
  ASSERT_EQ(paths.size(), 1u);
  EXPECT_EQ(paths[0].id, 1);
  EXPECT_EQ(paths[0].points, bent);
  EXPECT_EQ(paths[0].zones.size(), 1u);
  run.global_paths.push_back(path_at(70.0, 4, {{6.5, 0.2}, {10.0, 0.0}}));
  EXPECT_EQ(followed_paths(run, drive_window(run)).size(), 2u) << "a short cut to the same goal";
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
