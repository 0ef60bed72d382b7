#include "pan_tilt/pan_tilt.hpp"

#include <gtest/gtest.h>

namespace rover::gaze {
namespace {

constexpr Utime kStart = 1'000'000;

// A rover that drives and a unit that obeys at 20 deg/s, 50 times a second.
class PanTiltTest : public testing::Test {
 protected:
  struct Image {
    Utime asked;
    Gaze gaze;
  };
  PanTiltTest()
      : unit_{.pan_max_rad = to_rad(120.0),
              .tilt_min_rad = to_rad(-20.0),
              .tilt_max_rad = to_rad(45.0),
              .rate_radps = to_rad(20.0)},
        core_({}, unit_, {.height_m = 1.1, .pitch_down_rad = to_rad(17.0), .axes_x_m = 0.4}) {}

  void run(Task task, double seconds, double speed_mps = 0.0, double turn_radps = 0.0) {
    for (const Utime until = now_ + to_utime(seconds); now_ < until; now_ += kTickUs) {
      pose_.odom.yaw_rad += turn_radps * 0.02;
      pose_.odom.x_m += speed_mps * 0.02 * std::cos(pose_.odom.yaw_rad);
      pose_.odom.y_m += speed_mps * 0.02 * std::sin(pose_.odom.yaw_rad);
      pose_.travelled_m += speed_mps * 0.02;
      pose_.utime = now_;
      if (pose_comes_) core_.take_pose(pose_);
      move_unit();
      if (const auto gaze = core_.step(now_, task)) {
        images_.push_back({now_, *gaze});
        target_ = *gaze;
      }
    }
  }
  size_t count() {
    const size_t images = images_.size();
    images_.clear();
    return images;
  }

  PanTiltUnit unit_;
  PanTilt core_;
  Utime now_ = kStart;
  RoverPose pose_;
  bool pose_comes_ = true;
  bool unit_obeys_ = true;
  Gaze target_, stands_;
  std::vector<Image> images_;

 private:
  void move_unit() {
    const auto step = [](double is, double wanted) { return is + std::clamp(wanted - is, -0.007, 0.007); };
    if (!unit_obeys_) return;
    const Gaze before = stands_;
    stands_ = {step(stands_.pan_rad, target_.pan_rad), step(stands_.tilt_rad, target_.tilt_rad)};
    const bool moving = before.pan_rad != stands_.pan_rad || before.tilt_rad != stands_.tilt_rad;
    core_.take_unit({now_, stands_, moving});
  }
};

TEST_F(PanTiltTest, DoesNothingWhileIdle) {
  run(Task::kIdle, 20.0, 0.2, 0.1);
  EXPECT_EQ(count(), 0u);
}

TEST_F(PanTiltTest, AnImageAtOnceAndThenEachHalfMetre) {
  run(Task::kAhead, 25.1, 0.2);
  ASSERT_EQ(images_.size(), 11u);
  EXPECT_EQ(images_.front().asked, kStart);
  for (size_t i = 1; i < images_.size(); ++i)
    EXPECT_NEAR(to_seconds(images_[i].asked - images_[i - 1].asked), 2.5, 0.05);
  count();
  run(Task::kAhead, 30.0);
  EXPECT_EQ(count(), 0u) << "standing";
}

TEST_F(PanTiltTest, EverySecondImageAlongTheWayIsAGlanceToTheSidesInTurns) {
  run(Task::kAhead, 22.6, 0.2);
  std::vector<double> pans_deg;
  for (const Image& image : images_) pans_deg.push_back(std::round(to_deg(image.gaze.pan_rad)));
  EXPECT_EQ(pans_deg, (std::vector<double>{0, 40, 0, -40, 0, 40, 0, -40, 0, 40}));
}

TEST_F(PanTiltTest, ARoverThatTurnsLooksAheadAndGlancesNowhere) {
  run(Task::kAhead, 20.0, 0.2, to_rad(8.0));
  ASSERT_GE(images_.size(), 10u);
  for (const Image& image : images_) EXPECT_EQ(image.gaze.pan_rad, 0.0);
}

TEST_F(PanTiltTest, AnImageEachTwelveDegreesOfTurn) {
  run(Task::kAhead, 1.0);
  count();
  run(Task::kAhead, 10.0, 0.0, to_rad(6.0));
  EXPECT_NEAR(static_cast<double>(count()), 5.0, 1.0);
}

TEST_F(PanTiltTest, LooksWhereANewPathBends) {
  core_.take_path({{0.0, 0.0}, {10.0, 0.0}});
  run(Task::kAhead, 5.0);
  EXPECT_EQ(count(), 1u);
  core_.take_path({{0.0, 0.0}, {2.0, 0.0}, {2.0, 10.0}});
  run(Task::kAhead, 5.0);
  ASSERT_EQ(images_.size(), 1u);
  EXPECT_GT(images_[0].gaze.pan_rad, to_rad(40.0));
}

TEST_F(PanTiltTest, APictureIsWaitedForBeforeTheNextCommand) {
  run(Task::kSweep, 12.0);
  for (size_t i = 1; i < images_.size(); ++i) {
    const double way = std::max(std::abs(images_[i].gaze.pan_rad - images_[i - 1].gaze.pan_rad),
                                std::abs(images_[i].gaze.tilt_rad - images_[i - 1].gaze.tilt_rad));
    if (i + 1 == images_.size()) break;
    EXPECT_GE(to_seconds(images_[i + 1].asked - images_[i].asked), way / unit_.rate_radps + 0.18) << i;
  }
}

TEST_F(PanTiltTest, SweepsWhileItIsAskedToAndThenLooksAhead) {
  run(Task::kSweep, 19.0);
  ASSERT_GE(images_.size(), 10u);
  double least = 0.0, most = 0.0;
  for (size_t i = 0; i < 10; ++i) {
    least = std::min(least, images_[i].gaze.pan_rad);
    most = std::max(most, images_[i].gaze.pan_rad);
  }
  EXPECT_NEAR(least, to_rad(-60.0), 1e-9);
  EXPECT_NEAR(most, to_rad(60.0), 1e-9);
  run(Task::kSweep, 19.0);
  EXPECT_GE(count(), 20u) << "again";
  run(Task::kAhead, 8.0);
  ASSERT_EQ(images_.size(), 1u);
  EXPECT_EQ(images_[0].gaze.pan_rad, 0.0);
}

TEST_F(PanTiltTest, AStuckRoverSweepsOnceAfterAWhileAndLooksAheadAgain) {
  run(Task::kAhead, 5.0, 0.1);
  count();
  run(Task::kStuck, 2.9);
  EXPECT_EQ(count(), 0u);
  run(Task::kStuck, 60.0);
  ASSERT_EQ(images_.size(), 11u);
  EXPECT_EQ(images_.back().gaze.pan_rad, 0.0);
  EXPECT_NEAR(images_[9].gaze.pan_rad, to_rad(60.0), 1e-9);
  count();
  run(Task::kAhead, 1.0);
  run(Task::kStuck, 30.0);
  EXPECT_EQ(count(), 11u) << "stuck anew";
}

TEST_F(PanTiltTest, WithoutAPoseThereIsNoImageAlongTheWayButASweep) {
  pose_comes_ = false;
  run(Task::kAhead, 10.0, 0.2);
  EXPECT_EQ(count(), 0u);
  run(Task::kSweep, 5.0);
  EXPECT_GE(count(), 2u);
  pose_comes_ = true;
  run(Task::kAhead, 8.0);
  count();
  pose_comes_ = false;
  run(Task::kAhead, 10.0, 0.2, 0.1);
  EXPECT_EQ(count(), 0u) << "stale";
}

TEST_F(PanTiltTest, AUnitThatDoesNotComeIsToldAndHoldsNothingUp) {
  run(Task::kSweep, 3.0);
  EXPECT_FALSE(core_.unit_fails());
  unit_obeys_ = false;
  count();
  run(Task::kSweep, 40.0);
  EXPECT_TRUE(core_.unit_fails());
  EXPECT_GE(count(), 2u);
  unit_obeys_ = true;
  run(Task::kSweep, 20.0);
  EXPECT_FALSE(core_.unit_fails());
}

TEST_F(PanTiltTest, EnteringTheFullLevelAgainLooksAtOnce) {
  run(Task::kAhead, 2.0);
  run(Task::kIdle, 2.0);
  count();
  run(Task::kAhead, 2.0);
  EXPECT_EQ(count(), 1u);
}

}  // namespace
}  // namespace rover::gaze
