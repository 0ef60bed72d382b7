#include "tools/one_process/motion_errors.hpp"

#include <gtest/gtest.h>

#include "common/core/frames.hpp"

namespace rover {
namespace {

constexpr Utime kFrame = 400'000;

Eigen::Isometry3d at(double x_m, double yaw_rad = 0.0) {
  return make_pose(rotation_from_rpy(0.0, 0.0, yaw_rad), {x_m, 0.0, 0.0});
}

struct Drive {
  Eigen::Isometry3d end = Eigen::Isometry3d::Identity();
  int keyframes = 0;
};

Drive drive(MotionErrors& errors, int frames, double step_m) {
  Drive out;
  Utime keyframe = kNever;
  for (int i = 0; i < frames; ++i) {
    const auto motion = errors.step((i + 1) * kFrame, at(step_m * i));
    EXPECT_EQ(motion.has_value(), i > 0);
    if (!motion) continue;
    out.end = out.end * motion->T_prev_cur;
    if (motion->keyframe_utime != keyframe) ++out.keyframes;
    keyframe = motion->keyframe_utime;
  }
  return out;
}

TEST(MotionErrors, StandstillDoesNotDrift) {
  MotionErrors errors(3);
  const Drive stationary = drive(errors, 1000, 0.0);
  EXPECT_EQ(stationary.keyframes, 1);
  EXPECT_LT(stationary.end.translation().norm(), 1e-3);
}

TEST(MotionErrors, DriftIsThatOfAScaleAndOfKeyframes) {
  double sum_of_squares = 0.0;
  constexpr int kRuns = 40;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    MotionErrors errors(seed);
    const Drive straight = drive(errors, 501, 0.08);  // 40 m
    EXPECT_NEAR(straight.keyframes, 40.0 / 0.48, 3.0);
    sum_of_squares += std::pow(straight.end.translation().x() / 40.0 - 1.0, 2);
  }
  EXPECT_NEAR(std::sqrt(sum_of_squares / kRuns), 0.0011, 0.0004);
}

TEST(MotionErrors, ATurnChangesTheKeyframe) {
  MotionErrors errors(1);
  errors.step(kFrame, at(0.0));
  EXPECT_EQ(errors.step(2 * kFrame, at(0.0, 0.15))->keyframe_utime, kFrame);
  EXPECT_EQ(errors.step(3 * kFrame, at(0.0, 0.25))->keyframe_utime, kFrame);
  EXPECT_EQ(errors.step(4 * kFrame, at(0.0, 0.30))->keyframe_utime, 3 * kFrame);
}

TEST(MotionErrors, TheSameSeedGivesTheSameMotions) {
  MotionErrors a(7), b(7), c(8);
  const Drive first = drive(a, 20, 0.08);
  EXPECT_TRUE(first.end.matrix() == drive(b, 20, 0.08).end.matrix());
  EXPECT_FALSE(first.end.matrix() == drive(c, 20, 0.08).end.matrix());
}

}  // namespace
}  // namespace rover
