#include "localization/map_alignment.hpp"

#include <gtest/gtest.h>

namespace rover::loc {
namespace {

using Eigen::Vector3d;

ErrorCov wide_cov() {
  ErrorCov P = ErrorCov::Identity() * 1e-4;
  P(kPosition, kPosition) = P(kPosition + 1, kPosition + 1) = 1.0;
  P(kAttitude + 2, kAttitude + 2) = 0.01;
  return P;
}

TEST(MapAlignment, StartPosePlacesBodyInMap) {
  MapAlignment map({});
  const Eigen::Isometry3d T_odom_body = make_pose(rotation_from_rpy(0.1, 0.2, 0.7), {1.0, 2.0, 3.0});
  map.set_start({{100.0, 50.0, 10.0}, -2.0, 0.1, 0.1}, T_odom_body);
  const Eigen::Isometry3d T_map_body = map.T_map_odom() * T_odom_body;
  EXPECT_LT((T_map_body.translation() - Vector3d(100.0, 50.0, 10.0)).norm(), 1e-12);
  EXPECT_NEAR(yaw_of(T_map_body), -2.0, 1e-12);
  const Vector3d rpy = rpy_of(T_map_body.linear());
  EXPECT_NEAR(rpy.x(), 0.1, 1e-12);
  EXPECT_NEAR(rpy.y(), 0.2, 1e-12);
}

// A correction is in map axes, independent of the rover's heading.
TEST(MapAlignment, CorrectionIsIndependentOfHeading) {
  for (double yaw : {0.0, 1.0, -2.5, 3.1}) {
    MapAlignment map({});
    const Eigen::Isometry3d T_odom_body = make_pose(rotation_from_rpy(0.0, 0.0, yaw), {20.0, -5.0, 0.0});
    map.set_start({{100.0, 50.0, 0.0}, 0.3, 0.1, 0.1}, T_odom_body);
    MapMeasurement m;
    m.utime = 1;
    m.T_map_odom = planar(map.T_map_odom());
    m.cov = Vector3d(1e-9, 1e-9, 1e-11).asDiagonal();
    ASSERT_EQ(map.apply_correction(m, T_odom_body, wide_cov()), "");
    EXPECT_LT(((map.T_map_odom() * T_odom_body).translation() - Vector3d(100.0, 50.0, 0.0)).norm(), 1e-9)
        << "nothing to correct";
    m.utime = 2;
    m.T_map_odom.x_m += 1.0;
    m.T_map_odom.y_m -= 0.5;
    ASSERT_EQ(map.apply_correction(m, T_odom_body, wide_cov()), "");
    const Vector3d p = (map.T_map_odom() * T_odom_body).translation();
    EXPECT_LT((p - Vector3d(101.0, 49.5, 0.0)).norm(), 1e-6);
  }
}

TEST(MapAlignment, KalmanGainFollowsCovariances) {
  MapAlignment map({});
  const Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  map.set_start({{0.0, 0.0, 0.0}, 0.0, 0.1, 0.1}, T);
  MapMeasurement m;
  m.utime = 1;
  m.T_map_odom.x_m = 1.0;
  m.cov = Vector3d(1.0, 1.0, 0.01).asDiagonal();
  ASSERT_EQ(map.apply_correction(m, T, wide_cov()), "");
  EXPECT_NEAR(map.T_map_odom().translation().x(), 0.5, 1e-9);
  const ErrorCov P = map.updated_cov(wide_cov(), m.cov);
  EXPECT_NEAR(P(kPosition, kPosition), 0.5, 1e-9);
  EXPECT_NEAR(P(kBias, kBias), 1e-4, 1e-12);
}

TEST(MapAlignment, RejectsOutliersAndOldMeasurements) {
  MapAlignment map({});
  const Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  MapMeasurement m;
  m.utime = 10;
  m.cov = Vector3d(1e-4, 1e-4, 1e-4).asDiagonal();
  EXPECT_NE(map.apply_correction(m, T, wide_cov()), "") << "no start pose";
  map.set_start({{0.0, 0.0, 0.0}, 0.0, 0.1, 0.1}, T);
  m.T_map_odom.x_m = 10.0;
  EXPECT_NE(map.apply_correction(m, T, wide_cov()), "") << "ten sigma";
  EXPECT_EQ(map.T_map_odom().translation().x(), 0.0);
  m.T_map_odom.x_m = 0.1;
  EXPECT_EQ(map.apply_correction(m, T, wide_cov()), "");
  m.utime = 5;
  EXPECT_NE(map.apply_correction(m, T, wide_cov()), "") << "older";
  EXPECT_NE(map.rejection(m, T, wide_cov()), "") << "a SLAM pose older than the correction";
}

// A fix beside a ridge that runs at 30 deg: the pose stays as certain along the ridge as it was.
TEST(MapAlignment, AFixAlongOneAxisInflatesThatAxisAlone) {
  MapAlignment map({});
  map.set_start({{0.0, 0.0, 0.0}, 0.8, 0.1, 0.1}, Eigen::Isometry3d::Identity());
  const Eigen::Matrix3d ridge = rotation_from_rpy(0.0, 0.0, to_rad(30.0));
  const Eigen::Matrix3d R = ridge * Vector3d(144.0, 0.16, 0.05).asDiagonal() * ridge.transpose();
  const ErrorCov P = wide_cov();
  const ErrorCov inflated = map.inflated(P, R);
  const Eigen::Matrix3d to_map = rotation_from_rpy(0.0, 0.0, 0.8);
  Eigen::Matrix3d added = Eigen::Matrix3d::Zero();
  added.topLeftCorner<2, 2>() = (inflated - P).block<2, 2>(kPosition, kPosition);
  added = ridge.transpose() * to_map * added * to_map.transpose() * ridge;
  EXPECT_NEAR(added(0, 0), 0.0, 1e-9) << "along the ridge";
  EXPECT_NEAR(added(1, 1), 16.0, 1e-9);
  EXPECT_NEAR(inflated(kAttitude + 2, kAttitude + 2), P(kAttitude + 2, kAttitude + 2), 1e-12);
  const ErrorCov all = map.inflated(P, Vector3d(0.1, 0.1, 1e-4).asDiagonal());
  EXPECT_NEAR(all(kPosition, kPosition) - P(kPosition, kPosition), 16.0, 1e-9);
  EXPECT_NEAR(all(kAttitude + 2, kAttitude + 2) - P(kAttitude + 2, kAttitude + 2), std::pow(to_rad(4.0), 2), 1e-9);
}

class SlamSteps : public ::testing::Test {
 protected:
  SlamSteps() { map_.set_start({{0.0, 0.0, 0.0}, 0.0, 0.1, 0.1}, Eigen::Isometry3d::Identity()); }
  // One cloud, at x of map -> odom; odometry has gained this much noise since the start.
  // True if the motion since the cloud before is known.
  bool slam_at(double x_m, double noise_m2, double sigma_m) {
    MapMeasurement m;
    m.T_map_odom.x_m = x_m;
    m.cov = Eigen::Matrix3d::Identity() * sigma_m * sigma_m;
    odometry_.noise_m2 = noise_m2;
    return map_.add_slam_pose(m, odometry_);
  }
  double x_m() const { return map_.T_map_odom().translation().x(); }
  void settle() {
    for (int i = 0; i < 20; ++i) map_.step(1.0, odometry_.T_odom_body);
  }
  MapAlignment map_{{}};
  FilterState odometry_;
};

TEST_F(SlamSteps, NoiseOfOdometryBetweenCloudsDecides) {
  slam_at(0.0, 0.0, 0.1);
  slam_at(0.1, 25e-6, 0.1);  // as large as SLAM's own error
  map_.step(1.0, odometry_.T_odom_body);
  EXPECT_NEAR(x_m(), 0.02, 1e-9) << "bounded rate";
  settle();
  EXPECT_NEAR(x_m(), 0.05, 1e-9);
  slam_at(0.2, 25e-6, 0.1);
  settle();
  EXPECT_NEAR(x_m(), 0.05, 1e-9) << "odometry gained none";
  slam_at(0.3, 1.0, 0.1);
  settle();
  EXPECT_NEAR(x_m(), 0.15, 1e-4);
}

TEST_F(SlamSteps, NewAnchorIsNoMotion) {
  EXPECT_FALSE(slam_at(0.0, 0.0, 0.1));
  EXPECT_TRUE(slam_at(0.0, 0.0, 0.1));
  EXPECT_FALSE(slam_at(0.1, 1.0, 0.05));
  settle();
  EXPECT_EQ(x_m(), 0.0);
}

TEST_F(SlamSteps, StepOverACorrectionIsNoMotion) {
  slam_at(0.0, 0.0, 0.1);
  MapMeasurement correction;
  correction.utime = 1;
  correction.T_map_odom.x_m = 0.2;
  correction.cov = Eigen::Matrix3d::Identity() * 1e-9;
  ASSERT_EQ(map_.apply_correction(correction, odometry_.T_odom_body, wide_cov()), "");
  EXPECT_FALSE(slam_at(0.2, 1.0, 0.1));
  settle();
  EXPECT_NEAR(x_m(), 0.2, 1e-6);
}

}  // namespace
}  // namespace rover::loc
