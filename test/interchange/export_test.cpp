#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <rover/pose_t.hpp>

#include "../common/small_disk.hpp"
#include "../common/temp_folder.hpp"
#include "../replay/made_log.hpp"
#include "../report/message_log.hpp"
#include "common/bus/config.hpp"
#include "common/bus/interrupt.hpp"
#include "common/bus/user_files.hpp"
#include "tools/interchange/export_log.hpp"
#include "wild.hpp"

namespace rover::interchange {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class ExportTest : public testing::Test {
 protected:
  ExportTest() { const replay::MadeLog log(log_, 20); }
  // The error line.
  std::string refused(ExportOptions options) {
    try {
      export_log(options);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "not refused";
  }
  testing_support::TempFolder folder_;
  std::string log_ = folder_.file("made.lcm");
  std::string out_ = folder_.file("out");
};

TEST_F(ExportTest, WritesOneTablePerChannel) {
  export_log({.log = log_, .out = out_});
  const std::string slip = text_of(fs::path(out_) / "csv" / "SLIP.csv");
  EXPECT_EQ(std::count(slip.begin(), slip.end(), '\n'), 20);  // the head and 19 messages
  EXPECT_NE(slip.find("slip_ratio"), std::string::npos);
  EXPECT_TRUE(fs::exists(fs::path(out_) / "traverse.mcap"));
  EXPECT_TRUE(fs::exists(fs::path(out_) / "tracks.geojson"));
  EXPECT_FALSE(fs::exists(fs::path(out_) / "tum" / "truth.txt")) << "the log has none";
}

TEST_F(ExportTest, WritesOnlySelectedFormats) {
  export_log({.log = log_, .out = out_, .formats = {"csv"}, .channels = {"IMU"}});
  EXPECT_TRUE(fs::exists(fs::path(out_) / "csv" / "IMU.csv"));
  EXPECT_FALSE(fs::exists(fs::path(out_) / "csv" / "SLIP.csv"));
  EXPECT_FALSE(fs::exists(fs::path(out_) / "traverse.mcap"));
}

TEST_F(ExportTest, CountsUndecodableMessages) {
  {
    lcm::LogFile log(log_, "a");
    std::uint8_t bytes[] = {1, 2, 3};
    lcm::LogEvent event{};
    event.timestamp = 9'000'000;
    event.channel = "IMU";
    event.data = bytes;
    event.datalen = 3;
    log.writeEvent(&event);
  }
  const auto lines = export_log({.log = log_, .out = out_, .formats = {"csv"}});
  EXPECT_EQ(lines.front(), "IMU: 1 messages do not decode; skipped");
}

TEST_F(ExportTest, NeverMixesTwoRuns) {
  { const replay::MadeLog second(log_, 5, "a"); }
  const std::string said = folder_.short_names(refused({.log = log_, .out = out_}));
  EXPECT_EQ(said,
            "made.lcm: contains 2 runs, message time 1: 1.00 - 1.38 s, 2: 1.00 - 1.08 s; choose one with "
            "--log-run N");
  EXPECT_FALSE(fs::exists(out_));
  wild_row("Logs", "export of two runs in one file", "one trajectory of both, whose times fall", said);
  const auto lines = export_log({.log = log_, .out = out_, .log_run = 2, .formats = {"csv"}});
  EXPECT_EQ(folder_.short_names(lines.front()), "made.lcm: run 2 of 2, message time 1.00 - 1.08 s");
  const std::string slip = text_of(fs::path(out_) / "csv" / "SLIP.csv");
  EXPECT_EQ(std::count(slip.begin(), slip.end(), '\n'), 5);
}

TEST_F(ExportTest, JumpOfDaysIsReportedAndKept) {
  { const replay::MadeLog jumps(log_, 10, "w", 6, 3 * Utime{86'400'000'000}); }
  const auto lines = export_log({.log = log_, .out = out_, .formats = {"csv", "mcap"}});
  EXPECT_NE(lines.front().find("message time jumps from 1.08 to 259201.10 s"), std::string::npos) << lines.front();
  const std::string table = text_of(fs::path(out_) / "csv" / "TICK.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 11);
}

TEST_F(ExportTest, NonMonotonicPosesWithoutTicksAreReported) {
  {
    report::MessageLog log(log_);
    pose_t pose{};
    pose.quat_map_odom_wxyz[0] = pose.quat_odom_body_wxyz[0] = 1.0;
    for (const Utime t : {0, 20'000, 40'000, 0, 20'000}) log.put(channel::kPose, pose, t, "localization");
  }
  const auto lines = export_log({.log = log_, .out = out_, .formats = {"tum"}});
  const std::string line =
      "tum/estimate.txt: time decreases at 1 of its lines; without TICK the runs of the log cannot be separated";
  EXPECT_NE(std::find(lines.begin(), lines.end(), line), lines.end());
  wild_row("Logs", "export of two runs in one file that holds no TICK (rpg_dvs_ros #57)", "nothing is said", line);
}

// Channel names with path separators, in other alphabets, and in large number.
TEST_F(ExportTest, ChannelNamesNeverBecomePaths) {
  const auto outside = [&] { return std::distance(fs::recursive_directory_iterator(folder_.path()), {}); };
  const auto before = outside();
  {
    lcm::LogFile log(log_, "a");
    std::uint8_t byte = 7;
    for (int i = 0; i < 100; ++i) {
      const std::string name = i == 0 ? "../../escaped" : i == 1 ? "/camera/left" : i == 2 ? "\xe9" : std::to_string(i);
      lcm::LogEvent event{0, 0, name, 1, &byte};
      log.writeEvent(&event);
    }
  }
  const auto lines = export_log({.log = log_, .out = out_, .formats = {"csv"}});
  EXPECT_EQ(lines.front(),
            "100 messages on unknown channels; skipped: ../../escaped, /camera/left, "
            "10, 11, 12 ...");
  EXPECT_EQ(outside() - before, 2 + 3) << "the folder, csv, and a table for each channel of the project";
  wild_row("Logs",
           "export of a log with foreign channels: ../../escaped, /camera/left, bytes that are no UTF-8, 97 more",
           "a line for each, its bytes as they are", lines.front());
}

TEST_F(ExportTest, FullDiskPrintsOneLineAndLeavesNothing) {
  { const replay::MadeLog longer(log_, 2000); }
  for (const char* format : {"csv", "mcap"}) {
    const testing_support::SmallDisk disk(50'000);
    const std::string said = folder_.short_names(refused({.log = log_, .out = out_, .formats = {format}}));
    EXPECT_NE(said.find("cannot be written; is the disk full?"), std::string::npos) << said;
    EXPECT_FALSE(fs::exists(out_));
    wild_row("Outputs", std::string("export --format ") + format + " to a full disk", "one line, nothing left", said);
  }
}

// In a child process that exits like the command.
int export_in_child(const ExportOptions& options, int signal) {
  const pid_t child = fork();
  if (child == 0) {
    catch_interrupts();
    raise(signal);
    try {
      export_log(options);
    } catch (const ConfigError&) {
      _exit(2);
    }
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST_F(ExportTest, InterruptedExportLeavesNothingAndCanBeRepeated) {
  EXPECT_EQ(export_in_child({.log = log_, .out = out_}, SIGINT), 2);
  EXPECT_FALSE(fs::exists(out_));
  fs::create_directories(fs::path(out_) / ".unfinished" / "csv");  // remains after SIGKILL
  std::ofstream(fs::path(out_) / ".unfinished" / "csv" / "SLIP.csv") << "half";
  export_log({.log = log_, .out = user_path(out_ + "/"), .formats = {"csv"}});
  EXPECT_TRUE(fs::exists(fs::path(out_) / "csv" / "SLIP.csv"));
  EXPECT_FALSE(fs::exists(fs::path(out_) / ".unfinished"));
  wild_row("Outputs", "export --out DIR/, after one that was killed", "Directory not empty; then 'exists already'",
           "exported");
}

TEST_F(ExportTest, BadInputPrintsOneLineAndLeavesNothing) {
  EXPECT_NE(refused({.log = folder_.file("none.lcm"), .out = out_}).find("no such log"), std::string::npos);
  EXPECT_NE(refused({.log = log_, .out = out_, .formats = {"rosbag"}}).find("no format 'rosbag'"), std::string::npos);
  EXPECT_NE(refused({.log = log_, .out = out_, .channels = {"IMV"}}).find("no channel 'IMV'"), std::string::npos);
  std::ofstream(folder_.file("text.lcm")) << "this is no log of a rover, and it is longer than a header of one\n";
  EXPECT_NE(refused({.log = folder_.file("text.lcm"), .out = out_}).find("contains no messages"), std::string::npos);
  EXPECT_FALSE(fs::exists(out_));
  fs::create_directory(out_);
  std::ofstream(fs::path(out_) / "notes.txt") << "mine";
  EXPECT_NE(refused({.log = log_, .out = out_}).find("already exists"), std::string::npos);
  EXPECT_EQ(text_of(fs::path(out_) / "notes.txt"), "mine");
}

}  // namespace
}  // namespace rover::interchange
