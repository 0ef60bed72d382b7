// Traffic statistics as table and as JSON.
#include <gmock/gmock.h>

#include <limits>
#include <rover/hazards_t.hpp>
#include <rover/heartbeat_t.hpp>
#include <rover/slip_t.hpp>
#include <sstream>

#include "messages.hpp"
#include "tools/spy/field_lines.hpp"
#include "tools/spy/statistics_json.hpp"
#include "tools/spy/table.hpp"

namespace rover::spy {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::StartsWith;

slip_t some_slip() {
  auto slip = made<slip_t>(7'000'000, 3, "localization");
  slip.wheel_mps = 0.123456789;
  slip.slip_ratio = std::numeric_limits<double>::quiet_NaN();
  return slip;
}

hazards_t some_hazards() {
  auto hazards = made<hazards_t>(7'000'000, 3, "hazard_detector");
  hazards.cells_x = hazards.cells_y = 30;
  hazards.size = 900;
  hazards.cells.assign(900, 1);
  return hazards;
}

heartbeat_t some_heartbeat() {
  auto beat = made<heartbeat_t>(7'000'000, 3, "stereo");
  beat.text = "says \033[31mred\n";
  beat.input_count = 1;
  beat.inputs.resize(1);
  beat.inputs[0].channel = "IMU";
  return beat;
}

TrafficStatistics some_statistics() {
  TrafficStatistics statistics;
  statistics.now = 7'100'000;
  statistics.realtime_factor = 3.5;
  statistics.channels["SLIP"] = {"slip_t", {"localization"}, 42, 4200, 10.0, 900.0, 0.1, 2, 1, encoded(some_slip())};
  statistics.channels["HAZARDS"] = {"hazards_t", {"hazard_detector"},    7, 7000, 2.5, kNaN, 0.3, 0,
                                    0,           encoded(some_hazards())};
  statistics.channels["HEARTBEAT"] = {"heartbeat_t", {"stereo"}, 7, 70, 5.0, 1.0, 0.1, 0, 0, encoded(some_heartbeat())};
  statistics.channels["FOREIGN"] = {"", {}, 1, 3, kNaN, kNaN, kNaN, 0, 0, {1, 2, 3}};
  return statistics;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST(Table, ARowForEachChannelWithItsFields) {
  const auto lines = lines_of(table(some_statistics(), "udpm://somewhere", {}, {.columns = 400, .rows = 50}));
  ASSERT_EQ(lines.size(), 6U);
  EXPECT_THAT(lines[0], HasSubstr("message time 7.10 s   3.50 times real time"));
  EXPECT_THAT(lines, Contains(testing::AllOf(StartsWith("SLIP "), HasSubstr(" 10.00 "), HasSubstr(" 0.10 "),
                                             HasSubstr("wheel_mps=0.1235"), HasSubstr("slip_ratio=nan"))));
  EXPECT_THAT(lines, Contains(testing::AllOf(StartsWith("HAZARDS "), HasSubstr("cells=900 B"))));
  EXPECT_THAT(lines, Contains(testing::AllOf(StartsWith("FOREIGN "), HasSubstr("? 3 B"))));
}

TEST(Table, NoControlCharactersAndNoLineTooWide) {
  const std::string text = table(some_statistics(), "here", {}, {.columns = 90, .rows = 50});
  EXPECT_EQ(text.find('\033'), std::string::npos);
  for (const std::string& line : lines_of(text)) EXPECT_LE(line.size(), 90U);
  EXPECT_NE(table(some_statistics(), "here", {}, {.colours = true, .columns = 90, .rows = 50}).find('\033'),
            std::string::npos);
}

TEST(Table, RowsThatDoNotFitAreCounted) {
  const auto lines = lines_of(table(some_statistics(), "here", {}, {.columns = 90, .rows = 4}));
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_THAT(lines.back(), StartsWith("and 3 more lines"));
}

TEST(Table, SelectedChannelShowsAllFields) {
  const std::string text = table(some_statistics(), "here", {"HEARTBEAT"}, {.columns = 400, .rows = 99});
  EXPECT_THAT(text, HasSubstr("heartbeat_t from stereo"));
  EXPECT_THAT(text, HasSubstr("says ?[31mred?"));
  EXPECT_THAT(text, testing::ContainsRegex("channel +string +IMU"));
  EXPECT_THAT(text, testing::ContainsRegex("utime +int64_t +7000000"));
  EXPECT_EQ(text.find("SLIP"), std::string::npos);
}

TEST(FieldLines, LongArraysAreCutAndCounted) {
  const auto bytes = encoded(some_hazards());
  const auto fields = decode_fields("HAZARDS", bytes.data(), static_cast<int>(bytes.size()));
  ASSERT_TRUE(fields);
  EXPECT_THAT(
      field_lines(*fields),
      Contains(testing::ContainsRegex("cells +byte\\[900\\] +1 1 1 1 1 1 1 1 1 1 1 1 \\.\\.\\. \\(900 values\\)")));
}

TEST(Json, HasTheFiguresAndTheFields) {
  const auto json = statistics_json(some_statistics(), "here", {});
  EXPECT_EQ(json["now_s"], 7.1);
  const auto& slip = json["channels"]["SLIP"];
  EXPECT_EQ(slip["type"], "slip_t");
  EXPECT_EQ(slip["hz"], 10.0);
  EXPECT_EQ(slip["age_s"], 0.1);
  EXPECT_EQ(slip["gaps"], 2);
  EXPECT_EQ(slip["malformed"], 1);
  EXPECT_EQ(slip["fields"]["header"]["seq"], 3);
  EXPECT_EQ(slip["fields"]["wheel_mps"], 0.123456789);
  EXPECT_TRUE(slip["fields"]["slip_ratio"].is_null());
  EXPECT_EQ(json["channels"]["HAZARDS"]["fields"]["cells"], "900 values");
  EXPECT_TRUE(json["channels"]["FOREIGN"]["fields"].is_null());
}

TEST(Json, SelectedChannelHasCompleteArrays) {
  const auto json = statistics_json(some_statistics(), "here", {"HAZARDS"});
  ASSERT_EQ(json["channels"].size(), 1U);
  EXPECT_EQ(json["channels"]["HAZARDS"]["fields"]["cells"].size(), 900U);
}

TEST(Json, DimensionsNest) {
  const auto json = fields_json({{"m", "int8_t", {2, 3}, Field::Integers{1, 2, 3, 4, 5, 6}}}, 10);
  EXPECT_EQ(json.dump(), R"({"m":[[1,2,3],[4,5,6]]})");
}

}  // namespace
}  // namespace rover::spy
