#include "recorder/log_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numeric>

#include "../common/small_disk.hpp"
#include "../common/temp_folder.hpp"
#include "common/bus/config.hpp"
#include "common/bus/event_log.hpp"
#include "read_back.hpp"
#include "wild.hpp"

namespace rover::recorder {
namespace {

Event event(Utime release, const std::string& channel, std::vector<std::uint8_t> bytes) {
  Event e;
  e.release = release;
  e.channel = channel;
  e.bytes = std::move(bytes);
  return e;
}

class LogFileTest : public testing::Test {
 protected:
  LogFileTest() : path_(testing::TempDir() + "/log_file_test.lcm") { std::filesystem::remove(path_); }
  std::string path_;
};

TEST_F(LogFileTest, WrittenEventsReadBack) {
  {
    LogFile log(path_);
    EXPECT_TRUE(log.write(event(20, "IMU", {1, 2, 3})));
    EXPECT_TRUE(log.write(event(40, "TICK", {4})));
  }
  const std::vector<ReadBack> events = read_back(path_);
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0].timestamp, 20);
  EXPECT_EQ(events[0].channel, "IMU");
  EXPECT_EQ(events[0].bytes, (std::vector<std::uint8_t>{1, 2, 3}));
  EXPECT_EQ(events[1].channel, "TICK");
}

TEST_F(LogFileTest, TimeStampsAreMonotonic) {
  {
    LogFile log(path_);
    log.write(event(100, "A", {1}));
    log.write(event(80, "LATE", {1}));
  }
  EXPECT_EQ(read_back(path_)[1].timestamp, 100);
}

TEST_F(LogFileTest, AppendsAfterIncompleteRecordOfAKill) {
  {
    LogFile log(path_);
    for (int i = 0; i < 5; ++i) log.write(event(20 * i, "BEFORE", std::vector<std::uint8_t>(100, 7)));
  }
  std::filesystem::resize_file(path_, std::filesystem::file_size(path_) - 31);
  {
    LogFile log(path_);
    log.write(event(200, "AFTER", {9}));
  }
  const std::vector<ReadBack> events = read_back(path_);
  ASSERT_EQ(events.size(), 5u);
  EXPECT_EQ(events[3].channel, "BEFORE");
  EXPECT_EQ(events[4].channel, "AFTER");
  EXPECT_EQ(events[4].number, 4);
}

TEST_F(LogFileTest, FullDiskIsReported) {
  LogFile log("/dev/full");
  log.write(event(20, "IMU", {1, 2, 3}));
  EXPECT_FALSE(log.flush());
}

TEST(LogFileOnAFullDisk, TruncatesToLastCompleteRecord) {
  const testing_support::TempFolder folder;
  const std::string path = folder.file("log.lcm");
  int taken = 0;
  {
    const testing_support::SmallDisk disk(10'050);  // 76 records of 132 bytes, and a part of one
    LogFile log(path);
    while (log.write(event(taken, "DATA", std::vector<std::uint8_t>(100, 7))) && log.flush()) ++taken;
    EXPECT_EQ(taken, 76);
    EXPECT_FALSE(log.close());
    EXPECT_FALSE(log.write(event(99, "DATA", {1})));
  }
  EXPECT_EQ(std::filesystem::file_size(path), 76U * 132);
  EXPECT_EQ(read_back(path).size(), 76U);
}

class LogFileParts : public testing::Test {
 protected:
  void write(int from, int to) {
    LogFile log(path_, 1000);  // seven records of 132 bytes
    for (int i = from; i < to; ++i) ASSERT_TRUE(log.write(event(i, "DATA", std::vector<std::uint8_t>(100, 7))));
  }
  std::vector<Utime> times() const {
    std::vector<Utime> out;
    for_each_event(path_, [&](const LogEvent& e) { out.push_back(e.time); });
    return out;
  }
  testing_support::TempFolder folder_;
  std::string path_ = folder_.file("log.lcm");
};

TEST_F(LogFileParts, EachPartIsABoundedLog) {
  write(0, 20);
  EXPECT_EQ(log_parts(path_).size(), 3U);
  for (const std::string& part : log_parts(path_)) {
    EXPECT_LE(std::filesystem::file_size(part), 1000U);
    EXPECT_EQ(read_back(part).front().number, 0);
  }
  std::vector<Utime> all(20);
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(times(), all);
}

TEST_F(LogFileParts, RestartAppendsToLastPart) {
  write(0, 10);
  const std::string last = log_parts(path_).back();
  std::filesystem::resize_file(last, std::filesystem::file_size(last) - 5);  // a kill has cut record 9
  write(10, 12);
  EXPECT_EQ(log_parts(path_).size(), 2U);
  EXPECT_EQ(times(), (std::vector<Utime>{0, 1, 2, 3, 4, 5, 6, 7, 8, 10, 11}));
}

TEST_F(LogFileParts, OversizedMessageGetsItsOwnPart) {
  LogFile log(path_, 50);
  EXPECT_TRUE(log.write(event(0, "DATA", std::vector<std::uint8_t>(100, 7))));
  EXPECT_TRUE(log.write(event(1, "DATA", std::vector<std::uint8_t>(100, 7))));
  EXPECT_TRUE(log.close());
  EXPECT_EQ(times(), (std::vector<Utime>{0, 1}));
  EXPECT_EQ(log_parts(path_).size(), 2U);
}

TEST_F(LogFileTest, DoesNotOverwriteOtherFiles) {
  std::ofstream(path_) << "notes of somebody";
  std::string said;
  try {
    LogFile log(path_);
  } catch (const ConfigError& error) {
    said = error.what();
  }
  EXPECT_EQ(said, path_ + ": is not a log and is not overwritten; move it away");
  EXPECT_EQ(std::filesystem::file_size(path_), 17U);
  wild_row("Outputs", "a recorder whose traverse.lcm is a file of the user's", "cut to nothing",
           "log_file_test.lcm" + said.substr(path_.size()));
}

TEST_F(LogFileTest, UnwritablePathIsNamed) {
  try {
    LogFile log("/nowhere/traverse.lcm");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_EQ(std::string(error.what()), "/nowhere/traverse.lcm: cannot be written");
  }
}

}  // namespace
}  // namespace rover::recorder
