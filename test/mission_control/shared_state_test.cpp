// Command queue between HTTP threads and node.
#include "mission_control/shared_state.hpp"

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

TEST(CommandQueue, UnsentCommandIsWithdrawnAfterTimeout) {
  CommandQueue commands;
  EXPECT_EQ(commands.submit(command(CommandKind::kGo), 10ms).outcome, CommandReply::Outcome::kClockStopped);
  EXPECT_FALSE(commands.next()) << "it would move the rover when nobody expects it";
}

TEST(CommandQueue, StopStaysQueuedAfterTimeout) {
  CommandQueue commands;
  EXPECT_EQ(commands.submit(command(CommandKind::kEmergencyStop), 10ms).outcome, CommandReply::Outcome::kClockStopped);
  const auto waiting = commands.next();
  ASSERT_TRUE(waiting);
  EXPECT_EQ(waiting->command.kind, CommandKind::kEmergencyStop);
  EXPECT_FALSE(commands.next()) << "once";
}

TEST(CommandQueue, ConcurrentRepliesMatchTheirCommands) {
  CommandQueue commands;
  std::vector<CommandReply> answers(8);
  std::vector<std::thread> pages;
  for (CommandReply& answer : answers)
    pages.emplace_back([&] { answer = commands.submit(command(CommandKind::kGo), 20s); });
  for (std::int64_t id = 1; id <= 8;) {
    const auto waiting = commands.next();
    if (!waiting) {
      std::this_thread::yield();
      continue;
    }
    commands.set_command_id(waiting->ticket, id);
    ASSERT_TRUE(commands.acknowledge(id, id % 2 == 0, "odd"));
    EXPECT_FALSE(commands.acknowledge(id, true, "")) << "answered twice";
    ++id;
  }
  for (std::thread& page : pages) page.join();
  for (const CommandReply& answer : answers)
    EXPECT_EQ(answer.outcome,
              answer.command_id % 2 == 0 ? CommandReply::Outcome::kAccepted : CommandReply::Outcome::kRefused);
}

TEST(CommandQueue, LateReplyReturnsItsCommand) {
  CommandQueue commands;
  std::thread page(
      [&] { EXPECT_EQ(commands.submit(command(CommandKind::kGo), 500ms).outcome, CommandReply::Outcome::kNoReply); });
  std::optional<CommandQueue::Pending> waiting;
  while (!(waiting = commands.next())) std::this_thread::yield();
  commands.set_command_id(waiting->ticket, 5);
  page.join();
  EXPECT_TRUE(commands.acknowledge(5, true, ""));
}

TEST(CommandQueue, UnansweredCommandsDoNotLockOutLaterOnes) {
  CommandQueue commands;
  std::vector<std::thread> pages;
  for (int i = 0; i < 16; ++i)
    pages.emplace_back(
        [&] { EXPECT_EQ(commands.submit(command(CommandKind::kGo), 3s).outcome, CommandReply::Outcome::kNoReply); });
  for (std::int64_t id = 1; id <= 16;)
    if (const auto waiting = commands.next()) commands.set_command_id(waiting->ticket, id++);
  for (std::thread& page : pages) page.join();
  EXPECT_EQ(commands.submit(command(CommandKind::kGo), 10ms).outcome, CommandReply::Outcome::kClockStopped);
  EXPECT_FALSE(commands.acknowledge(1, true, "")) << "forgotten";
  EXPECT_TRUE(commands.acknowledge(16, true, "")) << "late";
}

TEST(CommandQueue, StopsQueuedWhileTheClockIsStoppedAreBounded) {
  CommandQueue commands;
  commands.submit(command(CommandKind::kEmergencyStop), 1ms);
  for (int i = 0; i < 20; ++i) commands.submit(command(CommandKind::kStop), 1ms);
  std::map<CommandKind, int> queued;
  while (const auto pending = commands.next()) ++queued[pending->command.kind];
  EXPECT_EQ(queued[CommandKind::kEmergencyStop], 1);
  EXPECT_GE(queued[CommandKind::kStop], 1);
  EXPECT_LE(queued[CommandKind::kStop], 5);
}

TEST(CommandQueue, FullQueueRefusesCommandsButTakesStop) {
  CommandQueue commands;
  std::vector<std::thread> pages;
  std::atomic<int> busy = 0;
  for (int i = 0; i < 24; ++i)
    pages.emplace_back([&] {
      if (commands.submit(command(CommandKind::kGo), 20s).outcome == CommandReply::Outcome::kBusy) ++busy;
    });
  while (busy < 8) std::this_thread::yield();
  EXPECT_EQ(commands.submit(command(CommandKind::kGo), 10ms).outcome, CommandReply::Outcome::kBusy);
  for (const CommandKind kind : {CommandKind::kStop, CommandKind::kPause, CommandKind::kEmergencyStop})
    EXPECT_EQ(commands.submit(command(kind), 10ms).outcome, CommandReply::Outcome::kClockStopped) << name(kind);
  std::map<CommandKind, int> queued;
  for (std::int64_t id = 1; const auto pending = commands.next(); ++id) {
    ++queued[pending->command.kind];
    commands.set_command_id(pending->ticket, id);
    commands.acknowledge(id, true, "");
  }
  for (std::thread& page : pages) page.join();
  EXPECT_EQ(busy, 8);
  EXPECT_EQ(queued, (std::map<CommandKind, int>{{CommandKind::kGo, 16},
                                                {CommandKind::kStop, 1},
                                                {CommandKind::kPause, 1},
                                                {CommandKind::kEmergencyStop, 1}}));
}

}  // namespace
}  // namespace rover::mission
