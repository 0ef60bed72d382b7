#include "common/bus/event_log.hpp"

#include <gtest/gtest.h>
#include <lcm/eventlog.h>

#include <filesystem>
#include <fstream>
#include <rover/slip_t.hpp>

#include "common/bus/config.hpp"
#include "common/bus/streams.hpp"
#include "temp_folder.hpp"

namespace rover {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

Bytes slip_bytes() {
  slip_t message{};
  message.header.publisher = "somebody";
  return encoded(message);
}

// Written by LCM.
void write_log(const std::string& path, int count, const std::string& channel, Bytes bytes) {
  lcm_eventlog_t* log = lcm_eventlog_create(path.c_str(), "w");
  for (int i = 0; i < count; ++i) {
    lcm_eventlog_event_t event{};
    event.timestamp = 1000 * i;
    event.channellen = static_cast<std::int32_t>(channel.size());
    event.channel = const_cast<char*>(channel.data());
    event.datalen = static_cast<std::int32_t>(bytes.size());
    event.data = bytes.data();
    lcm_eventlog_write_event(log, &event);
  }
  lcm_eventlog_destroy(log);
}

struct Read {
  LogLength length;
  std::vector<Utime> times;
};

Read read(const std::string& path) {
  Read out;
  out.length = for_each_event(path, [&](const LogEvent& event) { out.times.push_back(event.time); });
  return out;
}

void overwrite(const std::string& path, std::int64_t at, const std::string& bytes) {
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(at);
  file << bytes;
}

class EventLog : public testing::Test {
 protected:
  // A record of 28 + 4 + 100 bytes.
  void write(int count) { write_log(path_, count, "DATA", Bytes(100, 7)); }
  static constexpr std::int64_t kRecord = 132;

  testing_support::TempFolder folder_;
  std::string path_ = folder_.file("log.lcm");
};

TEST_F(EventLog, ReadsWhatLcmWrites) {
  write_log(path_, 3, "SLIP", slip_bytes());
  std::int64_t end = 0;
  const LogLength length = for_each_event(path_, [&](const LogEvent& event) {
    EXPECT_EQ(event.channel, "SLIP");
    EXPECT_EQ(Bytes(event.data, event.data + event.size), slip_bytes());
    EXPECT_EQ(event.begin, end);
    end = event.end;
  });
  EXPECT_EQ(length.records, 3);
  EXPECT_EQ(length.skipped_bytes, 0);
  EXPECT_EQ(length.damaged_places, 0);
  EXPECT_EQ(end, static_cast<std::int64_t>(fs::file_size(path_)));
}

TEST_F(EventLog, ACutAnywhereLeavesWhatIsWholeBeforeIt) {
  for (std::int64_t size = 0; size < 3 * kRecord; ++size) {
    write(3);
    fs::resize_file(path_, static_cast<std::uintmax_t>(size));
    const Read r = read(path_);
    EXPECT_EQ(r.length.records, size / kRecord) << size;
    EXPECT_EQ(r.length.skipped_bytes, size % kRecord) << size;
    EXPECT_EQ(r.length.damaged_places, size % kRecord == 0 ? 0 : 1) << size;
  }
}

TEST_F(EventLog, GoesOnBehindADamagedRecord) {
  const auto record = static_cast<std::int64_t>(28 + 4 + slip_bytes().size());
  for (const std::int64_t at : {0, 20, 24, 27}) {  // its first word, and the lengths
    write_log(path_, 5, "SLIP", slip_bytes());
    overwrite(path_, 2 * record + at, "\xff");
    const Read r = read(path_);
    EXPECT_EQ(r.times, (std::vector<Utime>{0, 1000, 3000, 4000})) << at;
    EXPECT_EQ(r.length.skipped_bytes, record) << at;
    EXPECT_EQ(r.length.damaged_places, 1) << at;
  }
}

// An unknown message cannot be distinguished from a truncated one if no record follows.
TEST_F(EventLog, AForeignMessageInFrontOfADamagedRecordIsNotTrusted) {
  write(5);
  overwrite(path_, 2 * kRecord, "\xff");
  EXPECT_EQ(read(path_).times, (std::vector<Utime>{0, 3000, 4000}));
}

TEST_F(EventLog, ForeignBytesBehindAMessageThatDecodesTakeNothingFromIt) {
  write_log(path_, 2, "SLIP", slip_bytes());
  std::ofstream(path_, std::ios::app) << "some other text";
  const Read r = read(path_);
  EXPECT_EQ(r.length.records, 2);
  EXPECT_EQ(r.length.skipped_bytes, 15);
}

// A damaged length may be up to the file size, and beyond LCM's limit.
TEST_F(EventLog, WhatAClaimedLengthWouldTakeIsNotRead) {
  const auto record = static_cast<std::int64_t>(28 + 4 + slip_bytes().size());
  for (const std::string length : {"\x7f\xff\xff\xff", "\x0f\xff\xff\xff"}) {
    write_log(path_, 3, "SLIP", slip_bytes());
    overwrite(path_, record + 24, length);
    fs::resize_file(path_, 300'000'000);  // a sparse file
    EventLogReader reader(path_);
    LogEvent event;
    EXPECT_TRUE(reader.next(event));
    EXPECT_TRUE(reader.next(event));
    EXPECT_EQ(event.time, 2000);
  }
  write_log(path_, 1, "SLIP", slip_bytes());
  overwrite(path_, 12, "\x80");  // its time
  EXPECT_EQ(read(path_).times.back(), -(Utime{1} << 53));
}

TEST_F(EventLog, PartsAreOneLog) {
  write(3);
  write_log(folder_.file("log-002.lcm"), 2, "DATA", Bytes(10, 1));
  write_log(folder_.file("log-004.lcm"), 9, "DATA", Bytes(10, 1));  // not read, because the third part is missing
  EXPECT_EQ(log_parts(path_), (std::vector<std::string>{path_, folder_.file("log-002.lcm")}));
  EXPECT_EQ(read(path_).length.records, 5);
  EXPECT_EQ(log_part("log.lcm", 17), "log-017.lcm");
  EXPECT_EQ(log_part("a/log.lcm", 1000), "a/log-1000.lcm");
}

TEST_F(EventLog, WhatIsNoLogIsNamed) {
  try {
    for_each_event(folder_.path().string(), [](const LogEvent&) {});
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_EQ(std::string(error.what()), folder_.path().string() + ": is not a regular file");
  }
  std::ofstream(path_) << "no log at all";
  EXPECT_EQ(read(path_).length.records, 0);
}

}  // namespace
}  // namespace rover
