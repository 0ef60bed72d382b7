// The desk between the page and the node: answers find their command, late ones are not given at all.
#include "mission_control/station.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace rover::mission {
namespace {

using namespace std::chrono_literals;

Command command(CommandKind kind) {
  Command out;
  out.kind = kind;
  return out;
}

TEST(Desk, ACommandThatWasNotTakenInTimeIsWithdrawn) {
  Desk desk;
  EXPECT_EQ(desk.give(command(CommandKind::kGo), 10ms).outcome, Answer::Outcome::kNoTime);
  EXPECT_FALSE(desk.take()) << "it would move the rover when nobody expects it";
}

TEST(Desk, AStopIsGivenHoweverLate) {
  Desk desk;
  EXPECT_EQ(desk.give(command(CommandKind::kEmergencyStop), 10ms).outcome, Answer::Outcome::kNoTime);
  const auto waiting = desk.take();
  ASSERT_TRUE(waiting);
  EXPECT_EQ(waiting->command.kind, CommandKind::kEmergencyStop);
  EXPECT_FALSE(desk.take()) << "once";
}

TEST(Desk, AnswersFindTheirCommand) {
  Desk desk;
  std::vector<Answer> answers(8);
  std::vector<std::thread> pages;
  for (Answer& answer : answers) pages.emplace_back([&] { answer = desk.give(command(CommandKind::kGo), 20s); });
  for (std::int64_t id = 1; id <= 8;) {
    const auto waiting = desk.take();
    if (!waiting) {
      std::this_thread::yield();
      continue;
    }
    desk.given(waiting->ticket, id);
    ASSERT_TRUE(desk.answered(id, id % 2 == 0, "odd"));
    EXPECT_FALSE(desk.answered(id, true, "")) << "answered twice";
    ++id;
  }
  for (std::thread& page : pages) page.join();
  for (const Answer& answer : answers)
    EXPECT_EQ(answer.outcome, answer.command_id % 2 == 0 ? Answer::Outcome::kAccepted : Answer::Outcome::kRefused);
}

TEST(Desk, ALateAnswerIsStillNoted) {
  Desk desk;
  std::thread page([&] { EXPECT_EQ(desk.give(command(CommandKind::kGo), 500ms).outcome, Answer::Outcome::kSilence); });
  std::optional<Desk::Waiting> waiting;
  while (!(waiting = desk.take())) std::this_thread::yield();
  desk.given(waiting->ticket, 5);
  page.join();
  EXPECT_TRUE(desk.answered(5, true, ""));
}

TEST(Desk, OneThatIsFullTakesNothingButStops) {
  Desk desk;
  std::vector<std::thread> pages;
  std::atomic<int> busy = 0;
  for (int i = 0; i < 24; ++i)
    pages.emplace_back([&] {
      if (desk.give(command(CommandKind::kGo), 1s).outcome == Answer::Outcome::kBusy) ++busy;
    });
  for (std::thread& page : pages) page.join();
  EXPECT_EQ(busy, 8);
}

}  // namespace
}  // namespace rover::mission
