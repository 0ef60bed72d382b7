// ./rover spy on a log, and its messages for missing or invalid logs.
#include <gmock/gmock.h>
#include <lcm/eventlog.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <rover/slip_t.hpp>
#include <rover/tick_t.hpp>

#include "../common/temp_folder.hpp"
#include "common/bus/config.hpp"
#include "messages.hpp"
#include "tools/spy/spy_command.hpp"
#include "wild.hpp"

namespace rover::spy {
namespace {

class SpyOnLog : public testing::Test {
 protected:
  SpyOnLog() { add_run(100); }
  void add_run(std::int64_t ticks) {
    lcm_eventlog_t* log = lcm_eventlog_create(log_.c_str(), "a");
    for (std::int64_t i = 0; i < ticks; ++i) {
      write(log, "TICK", i * kTickUs, encoded(made<tick_t>(i * kTickUs, i + 1, "world")));
      if (i % 5 == 0) write(log, "SLIP", i * kTickUs, encoded(made<slip_t>(i * kTickUs, i / 5 + 1, "localization")));
    }
    lcm_eventlog_destroy(log);
  }
  void add(const std::string& channel, const std::vector<std::uint8_t>& bytes, Utime time) {
    lcm_eventlog_t* log = lcm_eventlog_create(log_.c_str(), "a");
    write(log, channel, time, bytes);
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
  // Returns the exit status; `out_` and `errors_` hold stdout and stderr.
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
    errors_ = testing::internal::GetCapturedStderr() + thrown;
    return status;
  }

  testing_support::TempFolder folder_;
  std::string log_ = folder_.file("traverse.lcm");
  std::string out_;
  std::string errors_;
};

TEST_F(SpyOnLog, ShowsAllChannelsOfLog) {
  ASSERT_EQ(spy_with({.log = log_, .json = true}), 0) << errors_;
  const auto json = nlohmann::json::parse(out_);
  EXPECT_EQ(json["channels"]["TICK"]["messages"], 100);
  EXPECT_EQ(json["channels"]["SLIP"]["messages"], 20);
  EXPECT_NEAR(json["channels"]["SLIP"]["hz"], 10.0, 0.2);
  EXPECT_EQ(json["channels"]["SLIP"]["gaps"], 0);
  EXPECT_EQ(json["channels"]["SLIP"]["fields"]["header"]["utime"], 95 * kTickUs);
}

TEST_F(SpyOnLog, AcceptsRunFolder) {
  ASSERT_EQ(spy_with({.log = folder_.path()}), 0);
  EXPECT_THAT(out_, testing::ContainsRegex("SLIP +9|SLIP +10"));
}

TEST_F(SpyOnLog, DamagedLogIsShownWithWarning) {
  std::filesystem::resize_file(log_, std::filesystem::file_size(log_) - 3);
  ASSERT_EQ(spy_with({.log = log_, .json = true}), 0);
  EXPECT_EQ(nlohmann::json::parse(out_)["channels"]["TICK"]["messages"], 99);
  EXPECT_THAT(errors_, testing::HasSubstr("./rover repair"));
}

TEST_F(SpyOnLog, SelectsOneOfSeveralRuns) {
  add_run(30);
  EXPECT_EQ(spy_with({.log = log_}), 2);
  EXPECT_EQ(folder_.short_names(errors_),
            "traverse.lcm: contains 2 runs, message time 1: 0.00 - 1.98 s, 2: 0.00 - 0.58 s; choose one with --log-run "
            "N\n");
  wild_row("Logs", "spy on logs put together with cat", "dies of heap corruption", folder_.short_names(errors_));
  ASSERT_EQ(spy_with({.log = log_, .log_run = 2, .json = true}), 0);
  const auto json = nlohmann::json::parse(out_);
  EXPECT_EQ(json["channels"]["TICK"]["messages"], 30);
  EXPECT_EQ(json["channels"]["SLIP"]["messages"], 6);
  EXPECT_EQ(json["channels"]["SLIP"]["gaps"], 0);
  EXPECT_EQ(folder_.short_names(errors_), "traverse.lcm: run 2 of 2, message time 0.00 - 0.58 s\n");
}

TEST_F(SpyOnLog, UnknownChannelsAreShownWithoutFields) {
  const std::string latin = "caf\xe9";
  for (const std::string& name : {std::string("../../etc/passwd"), std::string("/camera/left"), latin})
    add(name, {1}, 0);
  ASSERT_EQ(spy_with({.log = log_, .json = true}), 0);
  const auto json = nlohmann::json::parse(out_);
  EXPECT_EQ(json["channels"].size(), 5U);
  EXPECT_EQ(json["channels"]["/camera/left"]["messages"], 1);
  ASSERT_EQ(spy_with({.log = log_}), 0);
  EXPECT_THAT(out_, testing::HasSubstr("caf? "));
  EXPECT_EQ(spy_with({.log = log_, .channels = {"\033[2J"}}), 2);
  EXPECT_THAT(errors_, testing::HasSubstr("caf?"));
  EXPECT_THAT(errors_, testing::Not(testing::HasSubstr("\033")));
  wild_row("Logs", "spy: a channel whose name is Latin-1, or has slashes",
           "in a refusal its bytes as they are on the terminal", "caf? in the table, U+FFFD in JSON");
}

// Recordings whose clock was set, or that have no timestamps.
TEST_F(SpyOnLog, AcceptsNonMonotonicAndZeroTimestamps) {
  for (const Utime time : {Utime{0}, std::numeric_limits<Utime>::max(), std::numeric_limits<Utime>::min(), Utime{-1}})
    add("FOREIGN", {1, 2}, time);
  add("TICK", encoded(made<tick_t>(std::numeric_limits<Utime>::min(), 101, "world")), 0);
  ASSERT_EQ(spy_with({.log = log_, .json = true}), 0);
  const auto json = nlohmann::json::parse(out_);
  EXPECT_EQ(json["channels"]["FOREIGN"]["messages"], 4);
  EXPECT_EQ(json["channels"]["TICK"]["malformed"], 1);
}

TEST_F(SpyOnLog, BadInputPrintsOneLineAndExits2) {
  const auto refused = [&](const SpyArguments& arguments, const std::string& why) {
    EXPECT_EQ(spy_with(arguments), 2);
    EXPECT_EQ(std::count(errors_.begin(), errors_.end(), '\n'), 1) << errors_;
    EXPECT_THAT(errors_, testing::HasSubstr(why));
    EXPECT_EQ(out_, "");
  };
  refused({.log = "/nowhere.lcm"}, "/nowhere.lcm: no such log");
  refused({.log = log_, .channels = {"POZE"}}, "there is no channel POZE; received: SLIP TICK");
  std::ofstream(folder_.file("text")) << "no log at all";
  refused({.log = folder_.file("text")}, "contains no messages");
  refused({.target = {.run = "/nowhere"}}, "/nowhere: no such run folder");
}

TEST_F(SpyOnLog, KnownChannelWithoutMessagesExits1) {
  EXPECT_EQ(spy_with({.log = log_, .channels = {"POSE"}}), 1);
  EXPECT_THAT(errors_, testing::HasSubstr("no message on POSE; received: SLIP TICK"));
}

}  // namespace
}  // namespace rover::spy
