// Command parser.
#include "mission_control/command.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace rover::mission {
namespace {

constexpr CommandLimits kLimits;

std::string error_of(const std::string& text) {
  const ParsedCommand parsed = parse_command(text, kLimits);
  EXPECT_NE(parsed.command.has_value(), !parsed.error.empty()) << text;
  return parsed.error;
}

TEST(Command, ParsesEveryKind) {
  const std::map<std::string, CommandKind> plain = {{"go", CommandKind::kGo},
                                                    {"stop", CommandKind::kStop},
                                                    {"pause", CommandKind::kPause},
                                                    {"resume", CommandKind::kResume},
                                                    {"clear_safe", CommandKind::kClearSafe},
                                                    {"emergency_stop", CommandKind::kEmergencyStop}};
  for (const auto& [name, kind] : plain) {
    const auto parsed = parse_command("{\"command\": \"" + name + "\"}", kLimits);
    ASSERT_TRUE(parsed.command) << parsed.error;
    EXPECT_EQ(parsed.command->kind, kind);
    EXPECT_EQ(mission::name(kind), name);
  }
}

TEST(Command, ParsesArguments) {
  const auto level = parse_command(R"({"command":"force_level","level":"full"})", kLimits);
  ASSERT_TRUE(level.command);
  EXPECT_EQ(level.command->level, Level::kFull);
  const auto fault = parse_command(R"({"command":"clear_fault","fault":"heartbeat.stereo"})", kLimits);
  ASSERT_TRUE(fault.command);
  EXPECT_EQ(fault.command->target, "heartbeat.stereo");
  const auto kill = parse_command(R"({"command":"kill","service":"stereo"})", kLimits);
  ASSERT_TRUE(kill.command);
  EXPECT_EQ(kill.command->target, "stereo");
  const auto locate = parse_command(R"({"command":"locate","within_m":500})", kLimits);
  ASSERT_TRUE(locate.command);
  EXPECT_EQ(locate.command->within_m, 500.0);
  EXPECT_EQ(description(*locate.command), "locate within 500 m");
  const auto path = parse_command(R"({"command":"path","points":[[1,2],[3.5,-4]],"level":"full"})", kLimits);
  ASSERT_TRUE(path.command);
  ASSERT_EQ(path.command->points.size(), 2U);
  EXPECT_EQ(path.command->points[1], Eigen::Vector2d(3.5, -4.0));
  EXPECT_EQ(path.command->level, Level::kFull);
}

TEST(Command, RefusesInvalidCommandsWithReason) {
  const std::vector<std::string> bad = {"",
                                        "go",
                                        "null",
                                        "[]",
                                        "{}",
                                        "{\"command\":\"go\"",
                                        R"({"command":1})",
                                        R"({"command":"GO"})",
                                        R"({"command":"drive"})",
                                        R"({"command":"go","speed":9})",
                                        R"({"command":"go","level":"full"})",
                                        R"({"command":"force_level"})",
                                        R"({"command":"force_level","level":"mars"})",
                                        R"({"command":"force_level","level":1})",
                                        R"({"command":"clear_fault","fault":""})",
                                        R"({"command":"clear_fault","fault":"a b"})",
                                        R"({"command":"kill","service":"../../bin/sh"})",
                                        R"({"command":"kill","service":"a;reboot"})",
                                        R"({"command":"kill"})",
                                        R"({"command":"hang","service":["stereo"]})",
                                        R"({"command":"locate"})",
                                        R"({"command":"locate","within_m":"500"})",
                                        R"({"command":"locate","within_m":0})",
                                        R"({"command":"locate","within_m":-5})",
                                        R"({"command":"locate","within_m":1e9})",
                                        R"({"command":"path"})",
                                        R"({"command":"path","points":[]})",
                                        R"({"command":"path","points":[[1,2]]})",
                                        R"({"command":"path","points":[[1,2],[3]]})",
                                        R"({"command":"path","points":[[1,2],[3,4,5]]})",
                                        R"({"command":"path","points":[[1,2],["3",4]]})",
                                        R"({"command":"path","points":[[1,2],[1e300,4]]})",
                                        R"({"command":"path","points":[[1,2],[null,4]]})",
                                        R"({"command":"path","points":[[1,2],[NaN,4]]})",
                                        R"({"command":"path","points":[[1,2],[3,4]],"level":"auto"})",
                                        R"({"command":"path","points":"all"})"};
  for (const std::string& text : bad) EXPECT_FALSE(error_of(text).empty()) << text;
}

TEST(Command, ParsesZones) {
  const auto parsed = parse_command(
      R"({"command":"zones","zones":[{"name":"dune 1","kind":"keep_out","points":[[1,2],[3,2],[3,5]]},
          {"name":"site","kind":"keep_in","points":[[-50,-50],[50,-50],[50,50],[-50,50]]}]})",
      kLimits);
  ASSERT_TRUE(parsed.command) << parsed.error;
  ASSERT_EQ(parsed.command->zones.size(), 2U);
  EXPECT_EQ(parsed.command->zones[0].name, "dune 1");
  EXPECT_FALSE(parsed.command->zones[0].keep_in);
  EXPECT_EQ(parsed.command->zones[0].points[2], Eigen::Vector2d(3.0, 5.0));
  EXPECT_TRUE(parsed.command->zones[1].keep_in);
  EXPECT_TRUE(parse_command(R"({"command":"zones","zones":[]})", kLimits).command) << "deletes all";
}

TEST(Command, RefusesWhatIsNoZone) {
  const auto with = [](const std::string& zone) { return error_of(R"({"command":"zones","zones":[)" + zone + "]}"); };
  EXPECT_EQ(with(R"({"name":"a","kind":"keep_out","points":[[1,2],[3,4]]})"),
            "zones: zone 'a' has fewer than 3 corners");
  EXPECT_EQ(with(R"({"name":"","kind":"keep_out","points":[[1,2],[3,4],[1,5]]})"), "zones: a zone has no name");
  EXPECT_NE(with(R"({"name":"a","kind":"no_go","points":[[1,2],[3,4],[1,5]]})"), "");
  EXPECT_NE(with(R"({"name":"a","kind":"keep_out","points":[[1,2],[3],[1,5]]})"), "");
  EXPECT_NE(with(R"({"name":"a","kind":"keep_out","points":[[1,2],["x",3],[1,5]]})"), "");
  EXPECT_NE(with(R"({"name":5,"kind":"keep_out","points":[[1,2],[3,4],[1,5]]})"), "");
  EXPECT_NE(with(R"({"name":"a\u0007","kind":"keep_out","points":[[1,2],[3,4],[1,5]]})"), "");
  EXPECT_NE(with(R"({"name":"a","kind":"keep_out","points":[[1,2],[3,4],[1,1e99]]})"), "");
  EXPECT_NE(with("7"), "");
  EXPECT_NE(error_of(R"({"command":"zones","zones":{}})"), "");
  EXPECT_NE(error_of(R"({"command":"zones"})"), "");
}

TEST(Command, RefusesTooManyWaypoints) {
  nlohmann::json request = {{"command", "path"}, {"points", nlohmann::json::array()}};
  for (size_t i = 0; i < kLimits.max_points; ++i) request["points"].push_back({i, i});
  EXPECT_EQ(error_of(request.dump()), "");
  request["points"].push_back({0, 0});
  EXPECT_NE(error_of(request.dump()), "");
}

TEST(Command, RefusesDeepNesting) {
  EXPECT_NE(error_of(std::string(60'000, '[')), "");
  EXPECT_NE(error_of("{\"command\":\"path\",\"points\":" + std::string(20'000, '[') + std::string(20'000, ']') + "}"),
            "");
}

TEST(Command, CheckRequestContainsPointsOnly) {
  EXPECT_EQ(parse_points(R"({"points":[[1,2],[3,4]]})", kLimits).points.size(), 2U);
  EXPECT_NE(parse_points(R"({"points":[[1,2],[3,4]],"go":1})", kLimits).error, "");
  EXPECT_NE(parse_points(R"([[1,2],[3,4]])", kLimits).error, "");
}

TEST(Command, ClassifiesStoppingCommands) {
  EXPECT_TRUE(stops(CommandKind::kStop) && stops(CommandKind::kPause) && stops(CommandKind::kEmergencyStop));
  for (const CommandKind kind : {CommandKind::kGo, CommandKind::kResume, CommandKind::kPath, CommandKind::kClearSafe})
    EXPECT_FALSE(stops(kind));
}

}  // namespace
}  // namespace rover::mission
