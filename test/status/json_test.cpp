#include <gtest/gtest.h>

#include "example_status.hpp"
#include "tools/status/snapshot_json.hpp"

namespace rover::status {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> keys_of(const Json& object) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.push_back(key);
  return keys;
}

// The value as a reader of the text finds it.
Json document(const Snapshot& snapshot) {
  return Json::parse(to_json(snapshot).dump(2));
}

TEST(StatusJson, KeysKeepTheirNamesAndOrder) {
  const Json json = document(example_status());
  EXPECT_EQ(keys_of(json), (std::vector<std::string>{"state", "level", "services", "faults", "channels", "state_for_s",
                                                     "transition", "permit", "hazard_stops", "clock", "run", "bus"}));
  EXPECT_EQ(keys_of(json["services"]),
            (std::vector<std::string>{"locomotion", "recorder", "rover_simulator", "stereo", "visual_odometry"}));
  EXPECT_EQ(keys_of(json["services"]["rover_simulator"]),
            (std::vector<std::string>{"pid", "alive", "age_s", "restarts", "cpu_percent", "rss_mb", "condition"}));
  EXPECT_EQ(keys_of(json["channels"]["POSE"]),
            (std::vector<std::string>{"hz", "age_s", "gaps", "malformed", "wall_hz", "bytes_per_s"}));
  EXPECT_EQ(keys_of(json["faults"][0]),
            (std::vector<std::string>{"id", "value", "limit", "condition", "response", "for_s"}));
}

TEST(StatusJson, NumbersAreNumbers) {
  const Json json = document(example_status());
  EXPECT_EQ(json["state"], "FAULT_STOP");
  EXPECT_EQ(json["level"], "EFFICIENT");
  const Json& recorder = json["services"]["recorder"];
  EXPECT_EQ(recorder["pid"], 102);
  EXPECT_EQ(recorder["alive"], true);
  EXPECT_EQ(recorder["age_s"], 0.18);
  EXPECT_EQ(recorder["restarts"], 0);
  EXPECT_EQ(recorder["cpu_percent"], 12.34);
  EXPECT_EQ(recorder["condition"], "DEGRADED");
  EXPECT_EQ(recorder["text"], "disk full: 12 MB left");
  EXPECT_EQ(json["channels"]["SLIP"]["hz"], 10.0);
  EXPECT_EQ(json["channels"]["SLIP"]["gaps"], 2);
  EXPECT_EQ(json["faults"][0]["value"], 3.52);
  EXPECT_EQ(json["transition"]["threshold"], 1.0);
}

TEST(StatusJson, UnknownValuesAreNull) {
  const Json json = document(example_status());
  EXPECT_EQ(json["services"]["stereo"]["alive"], false);
  for (const char* key : {"pid", "cpu_percent", "rss_mb"})
    EXPECT_TRUE(json["services"]["stereo"][key].is_null()) << key;
  EXPECT_TRUE(json["services"]["visual_odometry"]["age_s"].is_null());
  EXPECT_TRUE(json["faults"][1]["value"].is_null());
  EXPECT_TRUE(json["faults"][1]["response"].is_null());

  const Json nothing = document(Snapshot{});
  EXPECT_TRUE(nothing["state"].is_null());
  EXPECT_TRUE(nothing["level"].is_null());
  EXPECT_TRUE(nothing["services"].is_object());
  EXPECT_TRUE(nothing["faults"].is_array());
  EXPECT_TRUE(nothing["channels"].is_object());
  EXPECT_TRUE(nothing["clock"]["utime"].is_null());
}

}  // namespace
}  // namespace rover::status
