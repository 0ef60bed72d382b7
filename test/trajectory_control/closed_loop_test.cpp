// Trajectory control and locomotion with the default configuration in closed loop with a kinematic rover.
#include <gtest/gtest.h>

#include <random>

#include "test/trajectory_control/drive_loop.hpp"

namespace rover::control {
namespace {

using test::ArcPiece;
using test::DriveLoop;
using test::polyline;

struct Record {
  double cross_track_rms_m = 0.0;
  double cross_track_max_m = 0.0;
  double predicted_max_m = 0.0;
  double scrub_max_mps = 0.0;
  double wheel_max_mps = 0.0;
  double end_error_m = 0.0;
  double seconds = 0.0;
  bool ended = false;
  bool point_turned = false;
};

Record drive(DriveLoop& loop, const std::vector<Eigen::Vector2d>& points, double corridor = 0.75,
             double timeout_s = 900.0) {
  EXPECT_TRUE(loop.controller.set_path({1, corridor, points}));
  Record out;
  double squares = 0.0;
  int count = 0;
  const Utime start = loop.now;
  while (loop.now - start < to_utime(timeout_s) && loop.output.state != ControlState::kPathEnd) {
    loop.tick();
    out.point_turned |= loop.output.state == ControlState::kPointTurn;
    out.scrub_max_mps = std::max(out.scrub_max_mps, loop.rover.twist().scrub_mps);
    out.wheel_max_mps = std::max(out.wheel_max_mps, loop.rover.fastest_wheel_mps());
    if (loop.output.state != ControlState::kFollowing) continue;
    const double e = loop.output.cross_track_m;
    squares += e * e;
    ++count;
    out.cross_track_max_m = std::max(out.cross_track_max_m, std::abs(e));
    out.predicted_max_m = std::max(out.predicted_max_m, loop.output.predicted_corridor_error_m);
  }
  out.seconds = to_seconds(loop.now - start);
  out.ended = loop.output.state == ControlState::kPathEnd;
  loop.run(3.0);
  EXPECT_LT(loop.speed(), 1e-3);
  out.cross_track_rms_m = std::sqrt(squares / std::max(count, 1));
  out.end_error_m = std::hypot(loop.rover.pose().x_m - points.back().x(), loop.rover.pose().y_m - points.back().y());
  return out;
}

TEST(ClosedLoop, TracksSeedTraverseWithSixRepairs) {
  DriveLoop loop;
  const Record r = drive(loop, polyline(test::seed_traverse()));
  EXPECT_TRUE(r.ended);
  EXPECT_LT(r.cross_track_rms_m, 0.05);
  EXPECT_LT(r.cross_track_max_m, 0.10);
  EXPECT_LT(r.predicted_max_m, 0.15);
  EXPECT_LT(r.end_error_m, 0.05);
  EXPECT_LT(r.scrub_max_mps, 0.01);
  EXPECT_LT(r.wheel_max_mps, 0.30);
  EXPECT_FALSE(r.point_turned);
  EXPECT_GT(86.0 / (0.2 * r.seconds), 0.95);
  RecordProperty("cross_track_rms_mm", static_cast<int>(1e3 * r.cross_track_rms_m));
}

TEST(ClosedLoop, TracksAJaggedPath) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.02);
  auto points = polyline(test::seed_traverse());
  for (auto& p : points) p += Eigen::Vector2d(noise(random), noise(random));
  DriveLoop loop;
  const Record r = drive(loop, points);
  EXPECT_TRUE(r.ended);
  EXPECT_LT(r.cross_track_rms_m, 0.06);
  EXPECT_FALSE(r.point_turned);
  EXPECT_GT(86.0 / (0.2 * r.seconds), 0.90);
}

TEST(ClosedLoop, TracksWithNoisyPoses) {
  std::mt19937 random(4);
  std::normal_distribution<double> noise;
  DriveLoop loop;
  loop.modify_pose = [&](PoseInput& pose) {
    pose.odom.x_m += 0.005 * noise(random);
    pose.odom.y_m += 0.005 * noise(random);
    pose.odom.yaw_rad += 0.002 * noise(random);
    pose.forward_mps += 0.02 * noise(random);
    pose.left_mps += 0.02 * noise(random);
  };
  const Record r = drive(loop, polyline(test::seed_traverse()));
  EXPECT_TRUE(r.ended);
  EXPECT_LT(r.cross_track_rms_m, 0.05);
}

TEST(ClosedLoop, LateralOffsetDecaysWithoutOvershoot) {
  DriveLoop loop;
  loop.rover.put({0.0, 0.3, 0.0});
  loop.controller.set_path({1, 0.75, {{0.0, 0.0}, {20.0, 0.0}}});
  double lowest = 1.0;
  while (loop.rover.pose().x_m < 10.0) {
    loop.tick();
    lowest = std::min(lowest, loop.rover.pose().y_m);
    if (loop.rover.pose().x_m > 5.0) {
      EXPECT_LT(std::abs(loop.rover.pose().y_m), 0.03);
    }
  }
  EXPECT_GT(lowest, -0.04);
}

TEST(ClosedLoop, IntegralRemovesDriftOnASideSlope) {
  DriveLoop loop;
  loop.rover.side_slip = std::tan(to_rad(6.0));
  loop.controller.set_path({1, 0.75, {{0.0, 0.0}, {40.0, 0.0}}});
  double largest = 0.0;
  while (loop.rover.pose().x_m < 35.0) {
    loop.tick();
    largest = std::max(largest, std::abs(loop.rover.pose().y_m));
    if (loop.rover.pose().x_m > 25.0) {
      EXPECT_LT(std::abs(loop.rover.pose().y_m), 0.05);
    }
  }
  EXPECT_LT(largest, 0.15);
}

TEST(ClosedLoop, TracksWithLongitudinalSlip) {
  DriveLoop loop;
  loop.rover.slip_ratio = 0.4;
  const Record r = drive(loop, polyline({{0.0, 3.0}, {0.7, 1.0}, {-0.7, 1.0}, {0.0, 3.0}}));
  EXPECT_TRUE(r.ended);
  EXPECT_LT(r.cross_track_max_m, 0.25);
}

TEST(ClosedLoop, StartsWithAPointTurnForALargeHeadingError) {
  DriveLoop loop;
  loop.rover.put({0.0, 0.0, to_rad(120.0)});
  const Record r = drive(loop, {{0.0, 0.0}, {6.0, 0.0}});
  EXPECT_TRUE(r.ended);
  EXPECT_TRUE(r.point_turned);
  EXPECT_LT(r.cross_track_max_m, 0.10);
  EXPECT_LT(r.end_error_m, 0.05);
}

TEST(ClosedLoop, StartsWithAnArcForASmallHeadingError) {
  DriveLoop loop;
  loop.rover.put({0.0, 0.0, to_rad(30.0)});
  const Record r = drive(loop, {{0.0, 0.0}, {10.0, 0.0}});
  EXPECT_TRUE(r.ended);
  EXPECT_FALSE(r.point_turned);
  EXPECT_LT(r.cross_track_max_m, 0.35);
}

TEST(ClosedLoop, TurnsOnTheSpotAtCorners) {
  DriveLoop loop;
  const Record r = drive(loop, {{0, 0}, {4, 0}, {4, 4}, {0, 4}});
  EXPECT_TRUE(r.ended);
  EXPECT_TRUE(r.point_turned);
  EXPECT_LT(r.cross_track_max_m, 0.10);
  EXPECT_LT(r.end_error_m, 0.05);
}

TEST(ClosedLoop, BendsBelowTheMinimumRadiusStayInTheCorridor) {
  for (const double radius : {0.2, 0.4, 0.6, 0.8}) {
    DriveLoop loop;
    const Record r = drive(loop, polyline({{0.0, 3.0}, {1.0 / radius, radius * kPi / 2.0}, {0.0, 3.0}}, 0.05));
    EXPECT_TRUE(r.ended) << radius;
    EXPECT_LT(r.cross_track_max_m, 0.4) << radius;
    EXPECT_LT(r.end_error_m, 0.10) << radius;
  }
}

struct Replacement {
  double slowest_mps = kInfinity;
  double cross_track_max_m = 0.0;
};

// At 0.2 m/s on a line, switches to a repair that starts where the rover was 0.1 s ago and bends after straight_m.
Replacement replace_path_at_speed(double straight_m) {
  DriveLoop loop;
  loop.controller.set_path({1, 0.75, polyline({{0.0, 20.0}})});
  loop.run(20.0);
  EXPECT_NEAR(loop.speed(), 0.2, 0.01);
  std::vector<ArcPiece> pieces = {{0.0, straight_m}};
  test::append_repair(pieces, 1.0);
  const auto repair = polyline(pieces, 0.1, loop.rover.pose());
  loop.run(0.1);
  loop.controller.set_path({2, 0.75, repair});
  Replacement out;
  while (loop.output.state != ControlState::kPathEnd && loop.now < to_utime(200.0)) {
    loop.tick();
    if (loop.output.remaining_m > 0.5) out.slowest_mps = std::min(out.slowest_mps, loop.speed());
    out.cross_track_max_m = std::max(out.cross_track_max_m, std::abs(loop.output.cross_track_m));
  }
  EXPECT_EQ(loop.output.state, ControlState::kPathEnd);
  EXPECT_EQ(loop.output.path_id, 2);
  return out;
}

TEST(ClosedLoop, NewPathAtSpeedIsFollowedWithoutAStop) {
  const Replacement r = replace_path_at_speed(0.5);
  EXPECT_GT(r.slowest_mps, 0.09);
  EXPECT_LT(r.cross_track_max_m, 0.08);
}

TEST(ClosedLoop, NewPathThatBendsAtOnceIsReachedWithinTheSteeringLimits) {
  const Replacement r = replace_path_at_speed(0.1);
  EXPECT_GT(r.slowest_mps, 0.02);  // slow while the wheels steer, but no stop
  EXPECT_LT(r.cross_track_max_m, 0.15);
}

// Backtracking out of a blocked passage: the driven track in reverse, with the same controller.
TEST(ClosedLoop, BacktrackingPathIsDrivenInReverse) {
  DriveLoop loop;
  const auto track = polyline({{0.0, 1.0}, {0.7, 2.0}, {-0.7, 1.0}});
  ASSERT_TRUE(drive(loop, track).ended);
  std::vector<Eigen::Vector2d> back(track.rbegin(), track.rend());
  loop.controller.set_path({2, 0.25, back, std::vector<bool>(back.size(), true)});
  double largest = 0.0;
  bool turned = false;
  for (loop.tick(); loop.output.state != ControlState::kPathEnd && loop.now < to_utime(200.0); loop.tick()) {
    largest = std::max(largest, std::abs(loop.output.cross_track_m));
    turned |= loop.output.state == ControlState::kPointTurn;
    EXPECT_LE(loop.output.command.speed_mps, 0.0);
  }
  EXPECT_EQ(loop.output.state, ControlState::kPathEnd);
  loop.run(3.0);
  EXPECT_LT(loop.speed(), 1e-3);
  EXPECT_FALSE(turned);
  EXPECT_LT(largest, 0.08);
  EXPECT_NEAR(loop.rover.pose().x_m, 0.0, 0.06);
  EXPECT_NEAR(loop.rover.pose().y_m, 0.0, 0.06);
  EXPECT_NEAR(loop.rover.pose().yaw_rad, 0.0, 0.15);
}

// A track with two point turns 0.3 m apart, recorded in the rendered simulator.
TEST(ClosedLoop, BacktrackingOverAPointTurnStaysInTheCorridor) {
  DriveLoop loop;
  loop.rover.put({13.758, 3.431, to_rad(-47.6)});
  const std::vector<Eigen::Vector2d> back = {{13.758, 3.431}, {13.687, 3.364}, {13.629, 3.280}, {13.613, 3.179},
                                             {13.515, 3.204}, {13.415, 3.204}, {13.311, 3.206}, {13.211, 3.209},
                                             {13.107, 3.215}, {13.005, 3.201}, {12.903, 3.193}, {12.801, 3.184}};
  loop.controller.set_path({1, 0.25, back, std::vector<bool>(back.size(), true)});
  loop.run(0.1);
  while (loop.output.state != ControlState::kPathEnd && loop.now < to_utime(200.0)) {
    loop.tick();
    ASSERT_NE(loop.output.state, ControlState::kOutOfCorridor);
    EXPECT_LT(std::abs(loop.output.cross_track_m), 0.1);
  }
  EXPECT_EQ(loop.output.state, ControlState::kPathEnd);
}

// For any position of the point turn on the backtracking path and any heading.
TEST(ClosedLoop, BacktrackingOverAPointTurnNearItsStartStaysInTheCorridor) {
  for (const double first_m : {0.1, 0.15, 0.2, 0.25, 0.3, 0.4})
    for (const double turn_deg : {-150.0, -90.0, -50.0, 50.0, 90.0, 150.0})
      for (const double yaw_deg : {0.0, 90.0, 180.0, 270.0}) {
        DriveLoop loop;
        loop.rover.put({0.0, 0.0, to_rad(yaw_deg)});
        const Eigen::Vector2d along(std::cos(to_rad(turn_deg)), std::sin(to_rad(turn_deg)));
        std::vector<Eigen::Vector2d> back = {{0.0, 0.0}, {first_m, 0.0}};
        for (double distance_m = 0.1; distance_m < 1.05; distance_m += 0.1)
          back.push_back(back[1] + distance_m * along);
        loop.controller.set_path({1, 0.25, back, std::vector<bool>(back.size(), true)});
        loop.run(0.1);
        double largest = 0.0;
        while (loop.output.state != ControlState::kPathEnd && loop.now < to_utime(200.0) &&
               loop.output.state != ControlState::kOutOfCorridor) {
          loop.tick();
          largest = std::max(largest, std::abs(loop.output.cross_track_m));
        }
        EXPECT_EQ(loop.output.state, ControlState::kPathEnd) << first_m << " " << turn_deg << " " << yaw_deg;
        EXPECT_LT(largest, 0.2) << first_m << " " << turn_deg << " " << yaw_deg;
      }
}

// Forward, in reverse to the other side, forward again: cusps at 3.0 m and 5.0 m, all with the steering turned.
PathInput path_with_cusps() {
  PathInput path{1, 0.25, {{0.0, 0.0}}, {false}};
  Pose2 pose;
  const auto drive_leg = [&](double length_m, double curvature_per_m, bool reverse) {
    path.reverse.back() = reverse;
    const double step_m = reverse ? -0.1 : 0.1;
    for (double s = 0.05; s < length_m; s += 0.1) {
      const double middle_rad = pose.yaw_rad + 0.5 * step_m * curvature_per_m;
      pose.x_m += step_m * std::cos(middle_rad);
      pose.y_m += step_m * std::sin(middle_rad);
      pose.yaw_rad += step_m * curvature_per_m;
      path.points.emplace_back(pose.x_m, pose.y_m);
      path.reverse.push_back(reverse);
    }
  };
  drive_leg(2.0, 0.0, false);
  drive_leg(1.0, 0.4, false);
  drive_leg(2.0, -0.4, true);
  drive_leg(1.0, 0.4, false);
  drive_leg(3.0, 0.0, false);
  return path;
}

TEST(ClosedLoop, DrivesOverCuspsWithoutPointTurns) {
  const PathInput path = path_with_cusps();
  DriveLoop loop;
  ASSERT_TRUE(loop.controller.set_path(path));
  double largest_m = 0.0;
  std::vector<double> changes_m;  // arc lengths at which the rover first moves the other way
  bool backwards = false;
  for (loop.tick(); loop.output.state != ControlState::kPathEnd && loop.now < to_utime(200.0); loop.tick()) {
    ASSERT_NE(loop.output.state, ControlState::kPointTurn);
    ASSERT_NE(loop.output.state, ControlState::kOutOfCorridor);
    largest_m = std::max(largest_m, std::abs(loop.output.cross_track_m));
    if ((loop.output.command.speed_mps < 0.0) == backwards) continue;
    backwards = !backwards;
    changes_m.push_back(loop.output.arc_length_m);
  }
  EXPECT_EQ(loop.output.state, ControlState::kPathEnd);
  ASSERT_EQ(changes_m.size(), 2u);
  EXPECT_NEAR(changes_m[0], 3.0, 0.06);
  EXPECT_NEAR(changes_m[1], 5.0, 0.06);
  EXPECT_LT(largest_m, 0.12);
  EXPECT_LT((path.points.back() - Eigen::Vector2d(loop.rover.pose().x_m, loop.rover.pose().y_m)).norm(), 0.06);
}

// From the part on which the rover is.
PathInput without_parts(PathInput path, int driven) {
  size_t begin = 0;
  for (int part = 0; part < driven; ++part)
    begin = static_cast<size_t>(
        std::find(path.reverse.begin() + static_cast<long>(begin), path.reverse.end(), !path.reverse[begin]) -
        path.reverse.begin());
  path.points.erase(path.points.begin(), path.points.begin() + static_cast<long>(begin));
  path.reverse.erase(path.reverse.begin(), path.reverse.begin() + static_cast<long>(begin));
  return path;
}

// PATH begins with the part that is being driven, so a restarted controller gets the rest of the path.
TEST(ClosedLoop, RestartedAnywhereOnAPathWithCuspsItDrivesToTheEnd) {
  const PathInput path = path_with_cusps();
  DriveLoop first;
  ASSERT_TRUE(first.controller.set_path(path));
  struct Place {
    Pose2 pose;
    int driven;
  };
  std::vector<Place> places;
  int driven = 0;
  bool reverse = false;
  for (int i = 0; first.output.state != ControlState::kPathEnd && i < 10'000; ++i) {
    first.tick();
    const double speed_mps = first.output.command.speed_mps;
    if (speed_mps != 0.0 && (speed_mps < 0.0) != reverse) {
      reverse = !reverse;
      ++driven;
    }
    if (i % 50 == 0) places.push_back({first.rover.pose(), driven});
  }
  ASSERT_GT(places.size(), 20u);
  for (const Place& place : places) {
    SCOPED_TRACE(::testing::Message() << place.pose.x_m << " " << place.pose.y_m);
    DriveLoop loop;
    loop.rover.put(place.pose);
    ASSERT_TRUE(loop.controller.set_path(without_parts(path, place.driven)));
    double largest_m = 0.0;
    for (loop.tick(); loop.output.state != ControlState::kPathEnd && loop.now < to_utime(200.0); loop.tick()) {
      ASSERT_NE(loop.output.state, ControlState::kOutOfCorridor);
      largest_m = std::max(largest_m, std::abs(loop.output.cross_track_m));
    }
    EXPECT_EQ(loop.output.state, ControlState::kPathEnd);
    EXPECT_LT(largest_m, 0.2);
  }
}

// To see the ground ahead, a plan may back up on the line that it drives afterwards.
TEST(ClosedLoop, DrivesEachPartOfAPathThatLiesOnItself) {
  PathInput path{1, 0.25, {}, {}};
  for (int i = 0; i <= 2; ++i) path.points.emplace_back(0.1 * i, 0.02);
  path.reverse.assign(2, false);
  for (int i = 1; i >= -3; --i) path.points.emplace_back(0.1 * i, 0.0);
  path.reverse.resize(path.points.size() - 1, true);
  for (int i = -2; i <= 10; ++i) path.points.emplace_back(0.1 * i, 0.0);
  path.reverse.resize(path.points.size(), false);
  DriveLoop loop;
  ASSERT_TRUE(loop.controller.set_path(path));
  double min_x_m = 0.0;
  for (loop.tick(); loop.output.state != ControlState::kPathEnd && loop.now < to_utime(100.0); loop.tick())
    min_x_m = std::min(min_x_m, loop.rover.pose().x_m);
  EXPECT_EQ(loop.output.state, ControlState::kPathEnd);
  EXPECT_NEAR(min_x_m, -0.3, 0.06);
}

TEST(ClosedLoop, DrivesOutAndBackAlthoughItFacesTheWayBack) {
  DriveLoop loop;
  loop.rover.put({0.0, 0.0, kPi});
  ASSERT_TRUE(loop.controller.set_path({1, 0.75, {{0.0, 0.0}, {3.0, 0.0}, {0.0, 0.0}}}));
  double max_x_m = 0.0;
  for (loop.tick(); loop.output.state != ControlState::kPathEnd && loop.now < to_utime(200.0); loop.tick())
    max_x_m = std::max(max_x_m, loop.rover.pose().x_m);
  EXPECT_EQ(loop.output.state, ControlState::kPathEnd);
  EXPECT_GT(max_x_m, 2.7);  // it turns on the spot a little before the tip
}

TEST(ClosedLoop, ResendingTheSamePathChangesNothing) {
  DriveLoop once;
  DriveLoop again;
  const auto points = polyline({{0.0, 3.0}, {0.6, 2.0}, {-0.6, 2.0}});
  once.controller.set_path({1, 0.75, points});
  again.controller.set_path({1, 0.75, points});
  for (int i = 0; i < 1500; ++i) {
    if (i % 20 == 0) again.controller.set_path({1, 0.75, points});
    once.tick();
    again.tick();
    ASSERT_EQ(once.rover.pose().x_m, again.rover.pose().x_m);
    ASSERT_EQ(once.rover.pose().y_m, again.rover.pose().y_m);
  }
}

TEST(ClosedLoop, StalePoseStopsTheRover) {
  DriveLoop loop;
  loop.controller.set_path({1, 0.75, {{0.0, 0.0}, {20.0, 0.0}}});
  loop.run(10.0);
  const double x = loop.rover.pose().x_m;
  loop.pose_alive = false;
  loop.run(1.0);
  EXPECT_EQ(loop.output.state, ControlState::kStalePose);
  EXPECT_LT(loop.speed(), 0.01);
  EXPECT_LT(loop.rover.pose().x_m - x, 0.2 * 0.25 + 0.05 + 0.04);
  loop.pose_alive = true;
  loop.run(5.0);
  EXPECT_GT(loop.speed(), 0.15);
}

TEST(ClosedLoop, WithdrawnPermitStopsWithinTenCentimetres) {
  DriveLoop loop;
  loop.controller.set_path({1, 0.75, {{0.0, 0.0}, {20.0, 0.0}}});
  loop.run(10.0);
  const double x = loop.rover.pose().x_m;
  loop.permitted = false;
  loop.run(1.0);
  EXPECT_LT(loop.speed(), 0.01);
  EXPECT_LT(loop.rover.pose().x_m - x, 0.10);
}

TEST(ClosedLoop, LostLeaseStopsTheRover) {
  for (const bool permit_dies : {true, false}) {
    DriveLoop loop;
    loop.controller.set_path({1, 0.75, {{0.0, 0.0}, {20.0, 0.0}}});
    loop.run(10.0);
    const double x = loop.rover.pose().x_m;
    (permit_dies ? loop.permit_alive : loop.control_alive) = false;
    loop.run(1.0);
    EXPECT_LT(loop.speed(), 0.01) << permit_dies;
    EXPECT_LT(loop.rover.pose().x_m - x, 0.2 * 0.25 + 0.05 + 0.04) << permit_dies;
  }
}

TEST(ClosedLoop, OutOfCorridorStaysStationaryUntilANewPath) {
  DriveLoop loop;
  loop.controller.set_path({1, 0.5, {{0.0, 0.0}, {20.0, 0.0}}});
  loop.run(10.0);
  loop.rover.put({loop.rover.pose().x_m, 0.6, 0.0});
  loop.run(3.0);
  EXPECT_EQ(loop.output.state, ControlState::kOutOfCorridor);
  EXPECT_LT(loop.speed(), 1e-3);
  loop.controller.set_path({2, 0.5, {{loop.rover.pose().x_m, 0.6}, {20.0, 0.0}}});
  loop.run(5.0);
  EXPECT_EQ(loop.output.state, ControlState::kFollowing);
  EXPECT_GT(loop.speed(), 0.15);
}

}  // namespace
}  // namespace rover::control
