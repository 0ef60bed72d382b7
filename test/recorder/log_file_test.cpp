#include "recorder/log_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "common/bus/config.hpp"
#include "read_back.hpp"

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

TEST_F(LogFileTest, WhatIsWrittenReadsBack) {
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

TEST_F(LogFileTest, TimeStampsNeverFall) {
  {
    LogFile log(path_);
    log.write(event(100, "A", {1}));
    log.write(event(80, "LATE", {1}));
  }
  EXPECT_EQ(read_back(path_)[1].timestamp, 100);
}

TEST_F(LogFileTest, GoesOnAfterARecordThatAKillHasCut) {
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

TEST_F(LogFileTest, AFullDiskIsReportedNotFatal) {
  LogFile log("/dev/full");
  log.write(event(20, "IMU", {1, 2, 3}));
  EXPECT_FALSE(log.flush());
}

TEST_F(LogFileTest, APlaceThatCannotBeWrittenIsNamed) {
  try {
    LogFile log("/nowhere/traverse.lcm");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_EQ(std::string(error.what()), "/nowhere/traverse.lcm: cannot be written");
  }
}

}  // namespace
}  // namespace rover::recorder
