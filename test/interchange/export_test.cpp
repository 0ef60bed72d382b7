#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "../common/temp_folder.hpp"
#include "../replay/made_log.hpp"
#include "common/bus/config.hpp"
#include "interchange/export_log.hpp"

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
  // The line of the refusal.
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

TEST_F(ExportTest, writes_a_table_for_each_channel) {
  export_log({.log = log_, .out = out_});
  const std::string slip = text_of(fs::path(out_) / "csv" / "SLIP.csv");
  EXPECT_EQ(std::count(slip.begin(), slip.end(), '\n'), 20);  // the head and 19 messages
  EXPECT_NE(slip.find("slip_ratio"), std::string::npos);
  EXPECT_TRUE(fs::exists(fs::path(out_) / "traverse.mcap"));
  EXPECT_TRUE(fs::exists(fs::path(out_) / "tracks.geojson"));
  EXPECT_FALSE(fs::exists(fs::path(out_) / "tum" / "truth.txt")) << "the log has none";
}

TEST_F(ExportTest, writes_what_is_asked_for_alone) {
  export_log({.log = log_, .out = out_, .formats = {"csv"}, .channels = {"IMU"}});
  EXPECT_TRUE(fs::exists(fs::path(out_) / "csv" / "IMU.csv"));
  EXPECT_FALSE(fs::exists(fs::path(out_) / "csv" / "SLIP.csv"));
  EXPECT_FALSE(fs::exists(fs::path(out_) / "traverse.mcap"));
}

TEST_F(ExportTest, counts_what_does_not_decode) {
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
  EXPECT_EQ(lines.front(), "IMU: 1 messages do not decode; left out");
}

TEST_F(ExportTest, bad_input_is_one_line_and_leaves_nothing) {
  EXPECT_NE(refused({.log = folder_.file("none.lcm"), .out = out_}).find("no such log"), std::string::npos);
  EXPECT_NE(refused({.log = log_, .out = out_, .formats = {"rosbag"}}).find("no format 'rosbag'"), std::string::npos);
  EXPECT_NE(refused({.log = log_, .out = out_, .channels = {"IMV"}}).find("no channel 'IMV'"), std::string::npos);
  std::ofstream(folder_.file("text.lcm")) << "this is no log of a rover, and it is longer than a header of one\n";
  EXPECT_NE(refused({.log = folder_.file("text.lcm"), .out = out_}).find("holds no messages"), std::string::npos);
  EXPECT_FALSE(fs::exists(out_));
  EXPECT_FALSE(fs::exists(out_ + ".unfinished"));
  fs::create_directory(out_);
  EXPECT_NE(refused({.log = log_, .out = out_}).find("exists already"), std::string::npos);
  EXPECT_TRUE(fs::is_empty(out_));
}

}  // namespace
}  // namespace rover::interchange
