#include "pan_tilt/pan_tilt.hpp"

#include <gtest/gtest.h>

namespace rover::gaze {
namespace {

constexpr Utime kStart = 1'000'000;

// A moving rover and a unit that follows commands at 20 deg/s, in steps of 20 ms.
class PanTiltTest : public testing::Test {
 protected:
  struct Image {
    Utime requested;
    Gaze gaze;
  };
  PanTiltTest()
      : unit_{.pan_max_rad = to_rad(120.0),
              .tilt_min_rad = to_rad(-20.0),
              .tilt_max_rad = to_rad(45.0),
              .rate_radps = to_rad(20.0)},
        core_({}, unit_, {.height_m = 1.1, .pitch_down_rad = to_rad(17.0), .pan_axis_x_m = 0.4}) {}

  void run(Task task, double seconds, double speed_mps = 0.0, double turn_radps = 0.0) {
    for (const Utime until = now_ + to_utime(seconds); now_ < until; now_ += kTickUs) {
      pose_.odom.yaw_rad += turn_radps * 0.02;
      pose_.odom.x_m += speed_mps * 0.02 * std::cos(pose_.odom.yaw_rad);
      pose_.odom.y_m += speed_mps * 0.02 * std::sin(pose_.odom.yaw_rad);
      pose_.travelled_m += speed_mps * 0.02;
      pose_.utime = now_;
      if (send_pose_) core_.set_pose(pose_);
      move_unit();
      if (const auto gaze = core_.step(now_, task)) {
        images_.push_back({now_, *gaze});
        target_ = *gaze;
      }
    }
  }
  size_t take_image_count() {
    const size_t images = images_.size();
    images_.clear();
    return images;
  }

  PanTiltUnit unit_;
  PanTilt core_;
  Utime now_ = kStart;
  RoverPose pose_;
  bool send_pose_ = true;
  bool unit_moves_ = true;
  Gaze target_, unit_gaze_;
  std::vector<Image> images_;

 private:
  void move_unit() {
    const auto step = [](double actual, double target) { return actual + std::clamp(target - actual, -0.007, 0.007); };
    if (!unit_moves_) return;
    const Gaze before = unit_gaze_;
    unit_gaze_ = {step(unit_gaze_.pan_rad, target_.pan_rad), step(unit_gaze_.tilt_rad, target_.tilt_rad)};
    const bool moving = before.pan_rad != unit_gaze_.pan_rad || before.tilt_rad != unit_gaze_.tilt_rad;
    core_.set_unit_state({now_, unit_gaze_, moving});
  }
};

TEST_F(PanTiltTest, SendsNothingWhileIdle) {
  run(Task::kIdle, 20.0, 0.2, 0.1);
  EXPECT_EQ(take_image_count(), 0u);
}

TEST_F(PanTiltTest, ImageAtOnceAndThenEachHalfMetre) {
  run(Task::kAhead, 25.1, 0.2);
  ASSERT_EQ(images_.size(), 11u);
  EXPECT_EQ(images_.front().requested, kStart);
  for (size_t i = 1; i < images_.size(); ++i)
    EXPECT_NEAR(to_seconds(images_[i].requested - images_[i - 1].requested), 2.5, 0.05);
  take_image_count();
  run(Task::kAhead, 30.0);
  EXPECT_EQ(take_image_count(), 0u) << "stationary";
}

TEST_F(PanTiltTest, EverySecondImageGlancesToAlternatingSides) {
  run(Task::kAhead, 22.6, 0.2);
  std::vector<double> pans_deg;
  for (const Image& image : images_) pans_deg.push_back(std::round(to_deg(image.gaze.pan_rad)));
  EXPECT_EQ(pans_deg, (std::vector<double>{0, 40, 0, -40, 0, 40, 0, -40, 0, 40}));
}

TEST_F(PanTiltTest, NoGlancesWhileTurning) {
  run(Task::kAhead, 20.0, 0.2, to_rad(8.0));
  ASSERT_GE(images_.size(), 10u);
  for (const Image& image : images_) EXPECT_EQ(image.gaze.pan_rad, 0.0);
}

TEST_F(PanTiltTest, ImageEachTwelveDegreesOfTurn) {
  run(Task::kAhead, 1.0);
  take_image_count();
  run(Task::kAhead, 10.0, 0.0, to_rad(6.0));
  EXPECT_NEAR(static_cast<double>(take_image_count()), 5.0, 1.0);
}

TEST_F(PanTiltTest, LooksIntoTheBendOfANewPath) {
  core_.set_path({{0.0, 0.0}, {10.0, 0.0}});
  run(Task::kAhead, 5.0);
  EXPECT_EQ(take_image_count(), 1u);
  core_.set_path({{0.0, 0.0}, {2.0, 0.0}, {2.0, 10.0}});
  run(Task::kAhead, 5.0);
  ASSERT_EQ(images_.size(), 1u);
  EXPECT_GT(images_[0].gaze.pan_rad, to_rad(40.0));
}

TEST_F(PanTiltTest, NextCommandWaitsForTheImage) {
  run(Task::kSweep, 12.0);
  for (size_t i = 1; i < images_.size(); ++i) {
    const double move_rad = std::max(std::abs(images_[i].gaze.pan_rad - images_[i - 1].gaze.pan_rad),
                                     std::abs(images_[i].gaze.tilt_rad - images_[i - 1].gaze.tilt_rad));
    if (i + 1 == images_.size()) break;
    EXPECT_GE(to_seconds(images_[i + 1].requested - images_[i].requested), move_rad / unit_.rate_radps + 0.18) << i;
  }
}

TEST_F(PanTiltTest, RepeatsSweepsUntilTaskChangesThenLooksAhead) {
  run(Task::kSweep, 19.0);
  ASSERT_GE(images_.size(), 10u);
  double min_pan = 0.0, max_pan = 0.0;
  for (size_t i = 0; i < 10; ++i) {
    min_pan = std::min(min_pan, images_[i].gaze.pan_rad);
    max_pan = std::max(max_pan, images_[i].gaze.pan_rad);
  }
  EXPECT_NEAR(min_pan, to_rad(-60.0), 1e-9);
  EXPECT_NEAR(max_pan, to_rad(60.0), 1e-9);
  run(Task::kSweep, 19.0);
  EXPECT_GE(take_image_count(), 20u) << "again";
  run(Task::kAhead, 8.0);
  ASSERT_EQ(images_.size(), 1u);
  EXPECT_EQ(images_[0].gaze.pan_rad, 0.0);
}

TEST_F(PanTiltTest, StuckRoverSweepsOnceAfterDelayThenLooksAhead) {
  run(Task::kAhead, 5.0, 0.1);
  take_image_count();
  run(Task::kStuck, 2.9);
  EXPECT_EQ(take_image_count(), 0u);
  run(Task::kStuck, 60.0);
  ASSERT_EQ(images_.size(), 11u);
  EXPECT_EQ(images_.back().gaze.pan_rad, 0.0);
  EXPECT_NEAR(images_[9].gaze.pan_rad, to_rad(60.0), 1e-9);
  take_image_count();
  run(Task::kAhead, 1.0);
  run(Task::kStuck, 30.0);
  EXPECT_EQ(take_image_count(), 11u) << "stuck anew";
}

TEST_F(PanTiltTest, SweepsButDoesNotLookAheadWithoutPose) {
  send_pose_ = false;
  run(Task::kAhead, 10.0, 0.2);
  EXPECT_EQ(take_image_count(), 0u);
  run(Task::kSweep, 5.0);
  EXPECT_GE(take_image_count(), 2u);
  send_pose_ = true;
  run(Task::kAhead, 8.0);
  take_image_count();
  send_pose_ = false;
  run(Task::kAhead, 10.0, 0.2, 0.1);
  EXPECT_EQ(take_image_count(), 0u) << "stale";
}

TEST_F(PanTiltTest, UnitTimeoutIsReportedAndDoesNotBlock) {
  run(Task::kSweep, 3.0);
  EXPECT_FALSE(core_.unit_timed_out());
  unit_moves_ = false;
  take_image_count();
  run(Task::kSweep, 40.0);
  EXPECT_TRUE(core_.unit_timed_out());
  EXPECT_GE(take_image_count(), 2u);
  unit_moves_ = true;
  run(Task::kSweep, 20.0);
  EXPECT_FALSE(core_.unit_timed_out());
}

TEST_F(PanTiltTest, ImageAtOnceAfterReenteringFullLevel) {
  run(Task::kAhead, 2.0);
  run(Task::kIdle, 2.0);
  take_image_count();
  run(Task::kAhead, 2.0);
  EXPECT_EQ(take_image_count(), 1u);
}

}  // namespace
}  // namespace rover::gaze
