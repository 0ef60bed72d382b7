// The view is valid JSON for any bus content.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "mission_control/view.hpp"

namespace rover::mission {
namespace {

using nlohmann::json;

TEST(ViewJson, UnknownValuesAreNull) {
  const json view = json::parse(to_json(View{}, BookView{}));
  EXPECT_TRUE(view["t_s"].is_null());
  EXPECT_TRUE(view["pose"]["x_m"].is_null());
  EXPECT_TRUE(view["motion"]["slip"].is_null());
  EXPECT_EQ(view["state"]["name"], "");
  EXPECT_TRUE(view["services"].empty());
}

TEST(ViewJson, NumbersAreRounded) {
  View view;
  view.now = 12'345'678;
  view.pose.position_map_m = {12.34567, -3.0, 0.5};
  view.pose.yaw_rad = 1.23456789;
  view.state.faults = {"slip", "roll"};
  view.faults["slip"] = {0.91234, 0.8, "stop"};
  view.services["stereo"] = {Health::kLost, 1.5, 12.34, 100.4, 2, "why"};
  const json out = json::parse(to_json(view, BookView{7, 3, 86.0, "FULL", 2}));
  EXPECT_EQ(out["t_s"], 12.35);
  EXPECT_EQ(out["pose"]["x_m"], 12.346);
  EXPECT_EQ(out["state"]["faults"][0]["value"], 0.912);
  EXPECT_EQ(out["state"]["faults"][0]["response"], "stop");
  EXPECT_TRUE(out["state"]["faults"][1]["value"].is_null());
  EXPECT_EQ(out["services"][0]["health"], "lost");
  EXPECT_EQ(out["services"][0]["restarts"], 2);
  EXPECT_EQ(out["book"]["forced"], "FULL");
}

TEST(ViewJson, FullLevelServicesAreNullUntilReceived) {
  View view;
  for (const char* part : {"pan_tilt", "terrain", "slam", "correction"})
    EXPECT_TRUE(json::parse(to_json(view, BookView{}))[part].is_null()) << part;
  view.now = 9'000'000;
  view.pan_tilt = {8'900'000, 0.3, -0.1, true};
  view.terrain = {8'000'000, kNaN, 0.456};
  view.slam = {8'000'000, 1, 0.25, 90};
  view.correction = {4'000'000, false, kNaN, 0.4, "flat"};
  const json out = json::parse(to_json(view, BookView{}));
  EXPECT_EQ(out["pan_tilt"]["pan"], 0.3);
  EXPECT_EQ(out["pan_tilt"]["moving"], true);
  EXPECT_TRUE(out["terrain"]["difficulty"].is_null());
  EXPECT_EQ(out["terrain"]["known"], 0.46);
  EXPECT_EQ(out["slam"]["status"], 1);
  EXPECT_EQ(out["slam"]["particles"], 90);
  EXPECT_EQ(out["correction"]["age_s"], 5.0);
  EXPECT_EQ(out["correction"]["accepted"], false);
  EXPECT_EQ(out["correction"]["reason"], "flat");
}

TEST(ViewJson, InfinityAndInvalidUtf8AreValidJson) {
  View view;
  view.planner.blocked_in_m = kInfinity;
  view.state.cause = "\xff\xfe<script>\n\n\"";
  const std::string text = to_json(view, BookView{});
  const json out = json::parse(text);
  EXPECT_TRUE(out["planner"]["blocked_in_m"].is_null());
  EXPECT_EQ(text.find('\n'), std::string::npos) << "a line end would end the event";
}

TEST(ViewJson, ViewContainsNoGroundTruth) {
  const std::string view = to_json(View{}, BookView{});
  EXPECT_EQ(view.find("truth"), std::string::npos);
}

}  // namespace
}  // namespace rover::mission
