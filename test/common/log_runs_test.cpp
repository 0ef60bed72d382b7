// Real-world logs: several runs in one file, clock jumps, missing parts, and files that are not logs.
#include "common/bus/log_runs.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <rover/imu_t.hpp>
#include <rover/tick_t.hpp>

#include "../report/message_log.hpp"
#include "common/bus/channels.hpp"
#include "common/bus/config.hpp"
#include "temp_folder.hpp"
#include "wild.hpp"

namespace rover {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr Utime kDay = 86'400'000'000;
constexpr char kKind[] = "Logs";

class LogRuns : public testing::Test {
 protected:
  // IMU and TICK, 20 ms apart; each IMU is released with its TICK, and the last message follows the last TICK.
  static void add_run(report::MessageLog& log, Utime first, int ticks) {
    for (int k = 0; k < ticks; ++k) {
      log.put(channel::kImu, imu_t{}, first + k * kTickUs, "world");
      log.put(channel::kTick, tick_t{}, first + k * kTickUs, "world");
    }
    log.put(channel::kImu, imu_t{}, first + ticks * kTickUs, "world");
  }
  // One log per run, concatenated.
  void write_runs(const std::vector<Utime>& first_ticks) {
    std::ofstream all(path_, std::ios::binary);
    for (const Utime first : first_ticks) {
      const std::string one = folder_.file("one");
      {
        report::MessageLog log(one);
        add_run(log, first, 10);
      }
      all << std::ifstream(one, std::ios::binary).rdbuf();
      fs::remove(one);
    }
  }
  // The error line.
  std::string refused(const std::string& log, int number = 0) {
    try {
      choose_run(log, number);
    } catch (const ConfigError& error) {
      return folder_.short_names(error.what());
    }
    return "not refused";
  }
  std::string remark(const LogRun& run) {
    std::string text;
    for (const std::string& line : remarks(run)) text += folder_.short_names(line) + "; ";
    return text.substr(0, text.size() - std::min<size_t>(2, text.size()));
  }

  testing_support::TempFolder folder_;
  std::string path_ = folder_.file("log.lcm");
};

TEST_F(LogRuns, OneRunNeedsNoChoiceAndNoRemark) {
  write_runs({0});
  const LogRun run = choose_run(path_);
  EXPECT_EQ(run.records, 21);
  EXPECT_EQ(run.first_tick, 0);
  EXPECT_EQ(run.last_tick, 9 * kTickUs);
  EXPECT_THAT(remarks(run), ElementsAre());
  EXPECT_EQ(choose_run(path_, 1).records, 21);
  EXPECT_EQ(refused(path_, 2), "log.lcm: contains 1 run, message time 1: 0.00 - 0.18 s; there is no --log-run 2");
}

TEST_F(LogRuns, LogsThatWerePutTogetherAreSeveralRuns) {
  write_runs({5'000'000, 0, 0});
  const std::vector<LogRun> runs = log_runs(path_);
  ASSERT_EQ(runs.size(), 3U);
  std::int64_t in_all = 0;
  for (const LogRun& run : runs) {
    std::vector<Utime> times;
    for_each_event(run, [&](const LogEvent& event) { times.push_back(event.time); });
    EXPECT_EQ(times.size(), 21U) << "what is released before its first TICK belongs to it, and its end too";
    EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
    in_all += run.records;
  }
  EXPECT_EQ(in_all, 63);
  EXPECT_EQ(refused(path_),
            "log.lcm: contains 3 runs, message time 1: 5.00 - 5.18 s, 2: 0.00 - 0.18 s, 3: 0.00 - 0.18 s; choose one "
            "with --log-run N");
  EXPECT_EQ(remark(choose_run(path_, 2)), "log.lcm: run 2 of 3, message time 0.00 - 0.18 s");
  wild_row(kKind, "logs put together with cat (ZeroCM/zcm #395)", "replay plays the first, export mixes all",
           refused(path_));
}

TEST_F(LogRuns, RunsByTheClockThatWerePutTogetherAreTwo) {
  write_runs({20'000 * kDay, 20'001 * kDay});
  EXPECT_EQ(log_runs(path_).size(), 2U) << "their sequence numbers begin anew behind the gap";
}

TEST_F(LogRuns, AClockThatIsSetForwardLeavesAGapInOneRun) {
  {
    report::MessageLog log(path_);
    add_run(log, 0, 10);
    add_run(log, 3 * kDay, 10);
  }
  const LogRun run = choose_run(path_);
  EXPECT_EQ(run.records, 42);
  EXPECT_EQ(remark(run),
            "log.lcm: message time jumps from 0.18 to 259200.00 s: a clock that was set, or a pause of the recorder");
  wild_row(kKind, "message time that jumps by three days (ZeroCM/zcm #539)", "replay waits for three days",
           remark(run));
}

TEST_F(LogRuns, AClockThatIsSetBackBeginsARun) {
  {
    report::MessageLog log(path_);
    add_run(log, kDay, 10);
    add_run(log, 0, 10);
  }
  EXPECT_EQ(log_runs(path_).size(), 2U);
}

TEST_F(LogRuns, OneTimeThatIsNoneIsNoJump) {
  {
    report::MessageLog log(path_);
    add_run(log, 0, 10);
    log.put(channel::kTick, tick_t{}, 4'213'092'985'657'280'000, "world");
    add_run(log, 10 * kTickUs, 10);
  }
  const LogRun run = choose_run(path_);
  EXPECT_EQ(run.last_tick, 19 * kTickUs);
  EXPECT_EQ(run.bad_ticks, 1);
  wild_row(kKind, "a single time of 4.2e18 in the middle (Georacer/ardupilog #71)",
           "replay stops there: all later ticks are older", remark(run));
}

TEST_F(LogRuns, ATickOfAnotherVersionIsNoTick) {
  {
    report::MessageLog log(path_);
    add_run(log, 0, 3);
    log.put(channel::kTick, imu_t{}, 0, "world");
  }
  EXPECT_EQ(log_runs(path_).size(), 1U);
  EXPECT_EQ(remark(choose_run(path_)), "log.lcm: 1 TICK messages are damaged or of another version");
}

TEST_F(LogRuns, WithoutTicksALogIsOneRun) {
  {
    report::MessageLog log(path_);
    for (int i = 0; i < 5; ++i) log.put_bytes("/camera/left", {1, 2, 3}, 0);
  }
  const LogRun run = choose_run(path_);
  EXPECT_EQ(run.records, 5);
  EXPECT_EQ(run.last_tick, kNever);
}

TEST_F(LogRuns, ARunGoesOnInTheNextPart) {
  write_runs({5'000'000, 0});
  const LogRun second = choose_run(path_, 2);
  // The second part begins within the second run, after an empty part.
  std::int64_t cut = 0;
  int count = 0;
  for_each_event(second, [&](const LogEvent& event) { cut = ++count == 7 ? event.end : cut; });
  const std::string part = folder_.file("log-003.lcm");
  {
    std::ifstream in(path_, std::ios::binary);
    in.seekg(cut);
    std::ofstream(part, std::ios::binary) << in.rdbuf();
  }
  fs::resize_file(path_, static_cast<std::uintmax_t>(cut));
  EXPECT_EQ(choose_run(path_, 2).records, 7);
  EXPECT_THAT(remark(choose_run(path_, 2)),
              HasSubstr("log-002.lcm: this part of the log is missing; the following parts"));
  wild_row(kKind, "a log of several parts whose second is missing", "read to there in silence",
           remark(choose_run(path_, 2)));
  std::ofstream(folder_.file("log-002.lcm"));
  const LogRun whole = choose_run(path_, 2);
  EXPECT_EQ(whole.records, 21);
  EXPECT_EQ(whole.end.part, 2U);
  EXPECT_THAT(remark(whole), HasSubstr("log-002.lcm: this part of the log is empty"));
  int read = 0;
  for_each_event(whole, [&](const LogEvent&) { ++read; });
  EXPECT_EQ(read, 21);
}

TEST_F(LogRuns, DamageIsOfTheRunThatItLiesIn) {
  write_runs({5'000'000, 0});
  std::int64_t last = 0;
  for_each_event(choose_run(path_, 1), [&](const LogEvent& event) { last = event.begin; });
  std::fstream(path_, std::ios::binary | std::ios::in | std::ios::out).seekp(last) << "damage";
  EXPECT_EQ(choose_run(path_, 1).records, 20);
  EXPECT_GT(choose_run(path_, 1).skipped_bytes, 0);
  EXPECT_EQ(choose_run(path_, 2).records, 21);
  EXPECT_EQ(choose_run(path_, 2).skipped_bytes, 0);
}

TEST_F(LogRuns, WhatIsNoLogIsNamedInOneLine) {
  const auto row = [&](const std::string& input, const std::string& before, const std::string& said,
                       const std::string& line) {
    EXPECT_EQ(said, line);
    wild_row(kKind, input, before, said);
  };
  std::ofstream(folder_.file("empty.lcm"));
  row("an empty file", "no log of a rover", refused(folder_.file("empty.lcm")), "empty.lcm: is empty");
  std::ofstream(folder_.file("text.lcm")) << "no log at all";
  row("a text", "contains no messages", refused(folder_.file("text.lcm")),
      "text.lcm: contains no messages; is it an LCM log?");
  fs::create_directory(folder_.file("folder"));
  row("a folder without a log", "no such log", refused(folder_.file("folder")), "folder/traverse.lcm: no such log");
  ASSERT_EQ(mkfifo(folder_.file("fifo").c_str(), 0600), 0);
  row("a FIFO", "no such log", refused(folder_.file("fifo")), "fifo: is not a regular file");
  row("a device", "no such log", refused("/dev/zero"), "/dev/zero: is not a regular file");
  EXPECT_EQ(refused(folder_.file("none.lcm")), "none.lcm: no such log");
}

}  // namespace
}  // namespace rover
