#include "tools/repair/repair.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <rover/tick_t.hpp>
#include <sstream>

#include "../common/small_disk.hpp"
#include "../common/temp_folder.hpp"
#include "../recorder/read_back.hpp"
#include "common/bus/config.hpp"
#include "common/bus/streams.hpp"
#include "recorder/log_file.hpp"
#include "wild.hpp"

namespace rover::recorder {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

class Repair : public testing::Test {
 protected:
  // Records of 28 + 4 + 100 bytes.
  void write(const std::string& path, int count) {
    LogFile log(path);
    for (int i = 0; i < count; ++i) {
      Event event;
      event.release = 1000 * i;
      event.channel = "DATA";
      event.bytes.assign(100, static_cast<std::uint8_t>(i));
      ASSERT_TRUE(log.write(event));
    }
  }
  void damage(const std::string& path, std::int64_t at) {
    std::fstream(path, std::ios::binary | std::ios::in | std::ios::out).seekp(at) << "damage";
  }
  // The error line.
  std::string refusal(const RepairArguments& arguments) {
    try {
      repair(arguments);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "no refusal";
  }
  // The output of a repair.
  std::string done(const RepairArguments& arguments) {
    testing::internal::CaptureStdout();
    repair(arguments);
    return testing::internal::GetCapturedStdout();
  }

  static constexpr std::int64_t kRecord = 132;
  testing_support::TempFolder folder_;
  std::string log_ = folder_.file("traverse.lcm");
  std::string repaired_ = folder_.file("traverse.repaired.lcm");
};

TEST_F(Repair, TruncatedLogEndsAtLastCompleteMessage) {
  write(log_, 5);
  fs::resize_file(log_, 5 * kRecord - 1);
  const std::string before = content(log_);
  EXPECT_THAT(done({.log = log_}), HasSubstr("4 messages kept, 131 bytes at 1 place skipped"));
  EXPECT_EQ(content(log_), before) << "the damaged log stays as it is";
  EXPECT_EQ(content(repaired_), before.substr(0, 4 * kRecord));
  EXPECT_EQ(read_back(repaired_).size(), 4U);
}

TEST_F(Repair, DamagedMiddleIsDropped) {
  write(log_, 5);
  damage(log_, 2 * kRecord + 20);
  done({.log = log_, .out = folder_.file("mine.lcm")});
  const auto events = read_back(folder_.file("mine.lcm"));
  ASSERT_EQ(events.size(), 4U);
  EXPECT_EQ(events[1].timestamp, 1000);
  EXPECT_EQ(events[2].timestamp, 3000);
}

TEST_F(Repair, RepairsInPlaceOnlyOnRequest) {
  write(log_, 5);
  damage(log_, 2 * kRecord + 20);
  fs::resize_file(log_, 5 * kRecord - 7);
  done({.log = log_, .in_place = true});
  EXPECT_EQ(read_back(log_).size(), 3U);
  EXPECT_EQ(fs::file_size(log_), 3U * kRecord);
  EXPECT_FALSE(fs::exists(repaired_));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()), 1) << "nothing beside it";
}

TEST_F(Repair, ValidLogIsUnchanged) {
  write(log_, 5);
  EXPECT_THAT(done({.log = folder_.path()}), HasSubstr("intact, 5 messages"));
  EXPECT_FALSE(fs::exists(repaired_));
}

TEST_F(Repair, PartsAreRepairedSeparately) {
  write(log_, 5);
  write(folder_.file("traverse-002.lcm"), 3);
  fs::resize_file(folder_.file("traverse-002.lcm"), 3 * kRecord - 1);
  const std::string said = done({.log = log_});
  EXPECT_THAT(said, HasSubstr("traverse.lcm: intact, 5 messages"));
  EXPECT_THAT(said, HasSubstr("traverse-002.repaired.lcm: 2 messages kept"));
}

TEST_F(Repair, NothingIsOverwritten) {
  write(log_, 5);
  fs::resize_file(log_, 5 * kRecord - 1);
  std::ofstream(repaired_) << "mine";
  EXPECT_EQ(refusal({.log = log_}), repaired_ + ": already exists; remove it, or choose another file with --out");
  EXPECT_EQ(content(repaired_), "mine");
}

TEST_F(Repair, FullDiskLeavesLogUnchanged) {
  write(log_, 5);
  damage(log_, 2 * kRecord + 20);
  const std::string before = content(log_);
  for (const bool in_place : {false, true}) {
    const testing_support::SmallDisk disk(2 * kRecord);
    const std::string said = refusal({.log = log_, .in_place = in_place});
    EXPECT_THAT(said, HasSubstr("cannot be written; is the disk full?"));
    wild_row("Outputs", in_place ? "repair --in-place on a full disk" : "repair on a full disk",
             in_place ? "the damaged log is kept, the new one removed" : "one line, nothing left",
             "folder: cannot be written; is the disk full?");
  }
  EXPECT_EQ(content(log_), before);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()), 1) << "nothing beside it";
}

TEST_F(Repair, InPlaceThroughASymbolicLinkRepairsTheFile) {
  const std::string file = folder_.file("elsewhere.lcm");
  write(file, 5);
  damage(file, 2 * kRecord + 20);
  fs::create_symlink(file, log_);
  done({.log = log_, .in_place = true});
  EXPECT_TRUE(fs::is_symlink(log_));
  EXPECT_EQ(fs::file_size(file), 4U * kRecord);
  wild_row("Outputs", "repair --in-place of a symbolic link", "the link is replaced, the file stays damaged",
           "the file is repaired");
}

TEST_F(Repair, EmptyPartIsUnchanged) {
  write(log_, 5);
  fs::resize_file(log_, 5 * kRecord - 1);
  std::ofstream(folder_.file("traverse-002.lcm"));
  std::ofstream(folder_.file("traverse-003.lcm")) << "a page of something else";
  const std::string said = folder_.short_names(done({.log = log_}));
  EXPECT_EQ(said,
            "traverse.repaired.lcm: 4 messages kept, 131 bytes at 1 place skipped\n"
            "traverse-002.lcm: intact, 0 messages; nothing to do\n"
            "traverse-003.lcm: contains no intact message; not changed\n");
  wild_row("Logs", "repair of a log whose second part is empty", "holds no whole record; is it an LCM log?", said);
}

TEST_F(Repair, ReportsSeveralRunsInLog) {
  write(log_, 5);
  const auto tick = [](Utime t) {
    tick_t message{};
    message.header.utime = message.header.release_utime = t;
    Event event;
    event.release = t;
    event.channel = "TICK";
    event.bytes = encoded(message);
    return event;
  };
  {
    LogFile log(log_);
    for (const Utime t : {20'000, 40'000, 20'000}) ASSERT_TRUE(log.write(tick(t)));
  }
  EXPECT_THAT(done({.log = log_}), HasSubstr("contains 2 runs; select one in replay, export, report and spy"));
}

TEST_F(Repair, BadInputIsNamed) {
  EXPECT_EQ(refusal({.log = "/nowhere.lcm"}), "/nowhere.lcm: no such log");
  std::ofstream(log_) << "no log at all";
  EXPECT_EQ(refusal({.log = log_}), log_ + ": contains no intact record; is it an LCM log?");
  EXPECT_EQ(refusal({.log = log_, .in_place = true}), log_ + ": contains no intact record; is it an LCM log?");
  EXPECT_EQ(content(log_), "no log at all");
  fs::remove(log_);
  write(log_, 2);
  fs::resize_file(log_, 2 * kRecord - 1);
  EXPECT_EQ(refusal({.log = log_, .out = "/nowhere/x.lcm"}), "/nowhere: no such folder");
}

}  // namespace
}  // namespace rover::recorder
