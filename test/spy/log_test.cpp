// ./rover spy on a log, and what it says where there is none.
#include <gmock/gmock.h>
#include <lcm/eventlog.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <rover/slip_t.hpp>
#include <rover/tick_t.hpp>

#include "../common/temp_folder.hpp"
#include "common/bus/config.hpp"
#include "messages.hpp"
#include "spy/spy_command.hpp"

namespace rover::spy {
namespace {

class SpyOnLog : public testing::Test {
 protected:
  SpyOnLog() {
    lcm_eventlog_t* log = lcm_eventlog_create(log_.c_str(), "w");
    for (std::int64_t i = 0; i < 100; ++i) {
      write(log, "TICK", i * kTickUs, encoded(made<tick_t>(i * kTickUs, i + 1, "world")));
      if (i % 5 == 0) write(log, "SLIP", i * kTickUs, encoded(made<slip_t>(i * kTickUs, i / 5 + 1, "localization")));
    }
    lcm_eventlog_destroy(log);
  }
  static void write(lcm_eventlog_t* log, std::string channel, Utime time, std::vector<std::uint8_t> bytes) {
    lcm_eventlog_event_t event{};
    event.timestamp = time;
    event.channel = channel.data();
    event.channellen = static_cast<std::int32_t>(channel.size());
    event.data = bytes.data();
    event.datalen = static_cast<std::int32_t>(bytes.size());
    lcm_eventlog_write_event(log, &event);
  }
  // Exit status; `out_` and `said_` are what it wrote.
  int spy_with(const SpyArguments& arguments) {
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    int status = 2;
    std::string thrown;
    try {
      status = spy(arguments);
    } catch (const ConfigError& error) {
      thrown = std::string(error.what()) + "\n";
    }
    out_ = testing::internal::GetCapturedStdout();
    said_ = testing::internal::GetCapturedStderr() + thrown;
    return status;
  }

  testing_support::TempFolder folder_;
  std::string log_ = folder_.file("traverse.lcm");
  std::string out_;
  std::string said_;
};

TEST_F(SpyOnLog, TellsOfTheWholeLog) {
  ASSERT_EQ(spy_with({.log = log_, .json = true}), 0) << said_;
  const auto json = nlohmann::json::parse(out_);
  EXPECT_EQ(json["channels"]["TICK"]["messages"], 100);
  EXPECT_EQ(json["channels"]["SLIP"]["messages"], 20);
  EXPECT_NEAR(json["channels"]["SLIP"]["hz"], 10.0, 0.2);
  EXPECT_EQ(json["channels"]["SLIP"]["gaps"], 0);
  EXPECT_EQ(json["channels"]["SLIP"]["fields"]["header"]["utime"], 95 * kTickUs);
}

TEST_F(SpyOnLog, ARunsFolderWillDo) {
  ASSERT_EQ(spy_with({.log = folder_.path()}), 0);
  EXPECT_THAT(out_, testing::ContainsRegex("SLIP +9|SLIP +10"));
}

TEST_F(SpyOnLog, ADamagedLogIsShownAndSaidToBe) {
  std::filesystem::resize_file(log_, std::filesystem::file_size(log_) - 3);
  ASSERT_EQ(spy_with({.log = log_, .json = true}), 0);
  EXPECT_EQ(nlohmann::json::parse(out_)["channels"]["TICK"]["messages"], 99);
  EXPECT_THAT(said_, testing::HasSubstr("./rover repair"));
}

TEST_F(SpyOnLog, BadInputIsOneLineAndTwo) {
  const auto refused = [&](const SpyArguments& arguments, const std::string& why) {
    EXPECT_EQ(spy_with(arguments), 2);
    EXPECT_EQ(std::count(said_.begin(), said_.end(), '\n'), 1) << said_;
    EXPECT_THAT(said_, testing::HasSubstr(why));
    EXPECT_EQ(out_, "");
  };
  refused({.log = "/nowhere.lcm"}, "/nowhere.lcm: no such log");
  refused({.log = log_, .channels = {"POZE"}}, "there is no channel POZE; heard: SLIP TICK");
  std::ofstream(folder_.file("text")) << "no log at all";
  refused({.log = folder_.file("text")}, "holds no messages");
  refused({.target = {.run = "/nowhere"}}, "/nowhere: no such run folder");
}

TEST_F(SpyOnLog, AKnownChannelWithoutAMessageIsNoMistake) {
  EXPECT_EQ(spy_with({.log = log_, .channels = {"POSE"}}), 1);
  EXPECT_THAT(said_, testing::HasSubstr("no message on POSE; heard: SLIP TICK"));
}

}  // namespace
}  // namespace rover::spy
