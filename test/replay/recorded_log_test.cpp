#include "tools/replay/recorded_log.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "../common/temp_folder.hpp"
#include "common/bus/config.hpp"
#include "common/bus/event_log.hpp"
#include "made_log.hpp"
#include "wild.hpp"

namespace rover::replay {
namespace {

using testing_support::TempFolder;

class RecordedLogTest : public testing::Test {
 protected:
  std::string made(int count) {
    const std::string path = folder_.file("made.lcm");
    const MadeLog log(path, count);
    return path;
  }
  std::string refusal(const std::string& path) {
    try {
      RecordedLog log(path);
    } catch (const ConfigError& error) {
      return folder_.short_names(error.what());
    }
    return "not refused";
  }
  TempFolder folder_;
};

TEST_F(RecordedLogTest, GroupsMessagesBeforeEachTick) {
  RecordedLog log(made(3));
  EXPECT_EQ(log.ticks(), (std::vector<Utime>{1'000'000, 1'020'000, 1'040'000}));
  const auto first = log.next();
  ASSERT_TRUE(first);
  ASSERT_EQ(first->messages.size(), 1U);
  EXPECT_EQ(first->messages[0].channel, channel::kImu);
  const auto second = log.next();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->tick, 1'020'000);
  ASSERT_EQ(second->messages.size(), 2U);
  EXPECT_EQ(second->messages[1].header->publisher, "echo");
  EXPECT_TRUE(log.next());
  EXPECT_FALSE(log.next());
}

TEST_F(RecordedLogTest, SeeksToFirstTickAtOrAfterTime) {
  RecordedLog log(made(10));
  log.seek(1'050'000);
  EXPECT_EQ(log.next()->tick, 1'060'000);
  log.seek(0);
  EXPECT_EQ(log.next()->tick, 1'000'000);
  log.seek(9'000'000);
  EXPECT_EQ(log.next()->tick, 1'180'000);
}

TEST_F(RecordedLogTest, ReportsStreamsPerProcess) {
  const RecordedLog log(made(5));
  ASSERT_EQ(log.streams().size(), 3U);
  const RecordedStream& slip = log.streams()[1];
  EXPECT_EQ(slip.channel, channel::kSlip);
  EXPECT_EQ(slip.count, 4);
  EXPECT_EQ(slip.last_seq, 4);
  EXPECT_EQ(boots_of(log, "echo"), (std::map<std::int64_t, Utime>{{1, 1'080'000}}));
  EXPECT_TRUE(boots_of(log, "stereo").empty());
}

TEST_F(RecordedLogTest, TruncatedLogEndsAtLastCompleteTick) {
  const std::string path = made(5);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 10);
  const RecordedLog log(path);
  EXPECT_EQ(log.ticks().size(), 4U);
  EXPECT_GT(log.run().skipped_bytes, 0);
  EXPECT_EQ(log.skipped_messages(), 2) << "behind the last whole tick";
}

TEST_F(RecordedLogTest, ContinuesInNextPart) {
  const std::string path = made(6);
  const auto size = std::filesystem::file_size(path);
  // Cut between two records: the third TICK and what follows it.
  std::int64_t middle = 0;
  {
    int ticks = 0;
    for_each_event(path, [&](const LogEvent& event) {
      if (event.channel == channel::kTick && ++ticks == 3) middle = event.end;
    });
  }
  std::filesystem::copy_file(path, folder_.file("made-002.lcm"));
  std::filesystem::resize_file(path, static_cast<std::uintmax_t>(middle));
  {
    std::ifstream in(folder_.file("made-002.lcm"), std::ios::binary);
    std::string rest(size - static_cast<std::uintmax_t>(middle), '\0');
    in.seekg(middle);
    in.read(rest.data(), static_cast<std::streamsize>(rest.size()));
    std::ofstream(folder_.file("made-002.lcm"), std::ios::binary | std::ios::trunc) << rest;
  }
  RecordedLog log(path);
  EXPECT_EQ(log.ticks().size(), 6U);
  EXPECT_EQ(log.run().skipped_bytes, 0);
  for (int k = 1; k <= 6; ++k) EXPECT_EQ(log.next()->tick, MadeLog::tick_time(k));
  log.seek(MadeLog::tick_time(5));
  EXPECT_EQ(log.next()->messages.size(), 2U);
  log.seek(MadeLog::tick_time(2));
  EXPECT_EQ(log.next()->tick, MadeLog::tick_time(2));
}

TEST_F(RecordedLogTest, LogOfSeveralRunsIsPlayedByRun) {
  const std::string path = made(5);
  { const MadeLog second(path, 3, "a"); }
  EXPECT_EQ(refusal(path),
            "made.lcm: contains 2 runs, message time 1: 1.00 - 1.08 s, 2: 1.00 - 1.04 s; choose one "
            "with --log-run N");
  wild_row("Logs", "replay of two runs in one file", "the second is left out without a word", refusal(path));
  RecordedLog log(path, 2);
  EXPECT_EQ(log.ticks().size(), 3U);
  EXPECT_EQ(log.streams()[0].count, 3);
  for (int k = 1; k <= 3; ++k) EXPECT_EQ(log.next()->tick, MadeLog::tick_time(k));
  EXPECT_FALSE(log.next());
  log.seek(0);
  EXPECT_EQ(log.next()->messages.size(), 1U) << "nothing of the run before";
  EXPECT_EQ(RecordedLog(path, 1).ticks().size(), 5U);
}

TEST_F(RecordedLogTest, ContinuesAfterDamagedRecord) {
  const std::string path = made(5);
  std::int64_t begin = 0;
  for_each_event(path,
                 [&](const LogEvent& event) { begin = event.time == MadeLog::tick_time(3) ? event.begin : begin; });
  std::fstream(path, std::ios::binary | std::ios::in | std::ios::out).seekp(begin + 24) << "\x7f\xff\xff\xff";
  RecordedLog log(path);
  EXPECT_EQ(log.ticks().size(), 4U);
  EXPECT_EQ(log.ticks().back(), MadeLog::tick_time(5));
  wild_row("Logs", "replay of a log with a damaged record in the middle, which claims 2 GB", "ends there",
           "goes on behind it; remarks: " + folder_.short_names(remarks(log.run()).front()));
}

TEST_F(RecordedLogTest, CountsMessagesThatCannotBeSent) {
  const std::string path = made(3);
  {
    lcm::LogFile file(path, "a");
    std::uint8_t byte = 7;
    lcm::LogEvent event{0, MadeLog::tick_time(3), std::string(64, 'x'), 1, &byte};
    file.writeEvent(&event);
    event.channel = "/foreign";
    file.writeEvent(&event);
  }
  { const MadeLog later(path, 4, "a", 1, 3 * kTickUs); }
  RecordedLog log(path);
  EXPECT_EQ(log.ticks().size(), 7U);
  EXPECT_EQ(log.skipped_messages(), 1);
  log.seek(MadeLog::tick_time(4));
  EXPECT_EQ(log.next()->messages.front().channel, "/foreign");
}

TEST_F(RecordedLogTest, RefusesFilesThatAreNotLogs) {
  EXPECT_THROW(RecordedLog(folder_.file("absent.lcm")), ConfigError);
  std::ofstream(folder_.file("text.lcm")) << "this is no log of a rover, and it is longer than a header of one\n";
  EXPECT_THROW(RecordedLog(folder_.file("text.lcm")), ConfigError);
}

}  // namespace
}  // namespace rover::replay
