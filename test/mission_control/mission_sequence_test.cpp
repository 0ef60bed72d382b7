// The mission sequence issues each step until it is accepted, and never repeats an accepted one.
#include "mission_control/mission_sequence.hpp"

#include <gtest/gtest.h>

namespace rover {
namespace {

TEST(MissionSequence, IssuesStepsInOrderUntilAllAreAccepted) {
  MissionSequence sequence;
  const auto first = sequence.step(0, false, 7);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->mission_step, MissionStep::kStartPose);
  EXPECT_EQ(first->command_id, 7);
  EXPECT_FALSE(sequence.step(20'000, false, 8));  // waits for its answer
  EXPECT_TRUE(sequence.acknowledge(7, true, ""));
  EXPECT_EQ(sequence.step(40'000, false, 8)->mission_step, MissionStep::kPath);
  EXPECT_TRUE(sequence.acknowledge(8, true, ""));
  EXPECT_FALSE(sequence.step(60'000, false, 9));  // not before STANDBY
  EXPECT_EQ(sequence.step(80'000, true, 9)->mission_step, MissionStep::kGo);
  EXPECT_TRUE(sequence.acknowledge(9, true, ""));
  EXPECT_TRUE(sequence.all_accepted());
  EXPECT_FALSE(sequence.step(10'000'000, true, 10));
}

TEST(MissionSequence, RefusedStepIsRetriedAfterOneSecond) {
  MissionSequence sequence;
  sequence.step(0, false, 1);
  EXPECT_TRUE(sequence.acknowledge(1, false, "not level yet"));
  EXPECT_EQ(sequence.refusal(), "not level yet");
  EXPECT_FALSE(sequence.step(900'000, false, 2));
  EXPECT_TRUE(sequence.step(1'000'000, false, 2));
  EXPECT_FALSE(sequence.acknowledge(1, true, "")) << "an answer to another command";
  EXPECT_TRUE(sequence.acknowledge(2, true, ""));
  EXPECT_EQ(sequence.refusal(), "");
}

TEST(MissionSequence, RestartDoesNotRepeatAcceptedSteps) {
  for (int progress = 0; progress <= 3; ++progress) {
    MissionSequence sequence;
    sequence.resume_at(progress);
    EXPECT_EQ(sequence.progress(), progress);
    const auto next = sequence.step(0, true, 1);
    EXPECT_EQ(next.has_value(), progress < 3);
    if (next) {
      EXPECT_EQ(static_cast<int>(next->mission_step), progress);
    }
  }
  MissionSequence sequence;
  sequence.resume_at(99);
  EXPECT_EQ(sequence.progress(), 0);
}

TEST(MissionSequence, CancelledSequenceIssuesNothing) {
  MissionSequence sequence;
  sequence.step(0, true, 1);
  sequence.acknowledge(1, false, "not level yet");
  sequence.cancel();
  EXPECT_EQ(sequence.refusal(), "");
  EXPECT_FALSE(sequence.step(5'000'000, true, 2));
  EXPECT_FALSE(sequence.acknowledge(1, true, ""));
}

}  // namespace
}  // namespace rover
