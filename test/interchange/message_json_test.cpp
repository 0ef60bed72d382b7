#include "tools/interchange/message_json.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <rover/heartbeat_t.hpp>
#include <rover/service_state_t.hpp>
#include <rover/slip_t.hpp>

#include "common/bus/channels.hpp"
#include "common/bus/streams.hpp"
#include "common/core/frames.hpp"
#include "tools/interchange/foxglove.hpp"

namespace rover::interchange {
namespace {

using nlohmann::json;

template <class Message>
json as_json(const char* channel, const Message& message) {
  std::vector<std::uint8_t> bytes = encoded(message);
  return json::parse(json_text(decode_fields(channel, bytes.data(), static_cast<int>(bytes.size())).value()));
}

TEST(MessageJson, KeepsNumbersTextsAndNesting) {
  heartbeat_t heartbeat{};
  heartbeat.header.seq = 5;
  heartbeat.service = "stereo";
  heartbeat.text = "quote \" and \n line";
  heartbeat.cpu_s = 0.1;
  heartbeat.input_count = 1;
  heartbeat.inputs.resize(1);
  heartbeat.inputs[0].gaps = 9;
  const json value = as_json(channel::kHeartbeat, heartbeat);
  EXPECT_EQ(value["header"]["seq"], 5);
  EXPECT_EQ(value["text"], heartbeat.text);
  EXPECT_EQ(value["cpu_s"], 0.1);
  EXPECT_EQ(value["inputs"][0]["gaps"], 9);
}

TEST(MessageJson, NumbersThatAreNotFiniteAreNull) {
  slip_t slip{};
  slip.slip_ratio = kNaN;
  slip.wheel_mps = kInfinity;
  const json value = as_json(channel::kSlip, slip);
  EXPECT_TRUE(value["slip_ratio"].is_null());
  EXPECT_TRUE(value["wheel_mps"].is_null());
}

TEST(MessageJson, BytesAreBase64) {
  service_state_t state{};
  state.size = 3;
  state.data = {0xff, 0x00, 0x41};
  EXPECT_EQ(as_json(channel::kServiceState, state)["data"], "/wBB");
}

TEST(MessageJson, TheSchemaNamesEveryField) {
  const json schema = json::parse(json_schema("heartbeat_t"));
  EXPECT_EQ(schema["properties"]["cpu_s"]["type"], "number");
  EXPECT_EQ(schema["properties"]["pid"]["type"], "integer");
  EXPECT_EQ(schema["properties"]["inputs"]["items"]["properties"]["channel"]["type"], "string");
}

TEST(Foxglove, PicturesAndFrames) {
  image_t image{};
  image.width = 4;
  image.height = 2;
  image.size = 8;
  image.data = {1, 2, 3, 4, 5, 6, 7, 8};
  image.header.utime = 1'500'000;
  const json picture = json::parse(foxglove::compressed_image(image, "LOCCAM_LEFT"));
  EXPECT_EQ(picture["format"], "png");
  EXPECT_EQ(picture["data"].get<std::string>().substr(0, 11), "iVBORw0KGgo");  // the signature of PNG
  EXPECT_EQ(picture["timestamp"]["sec"], 1);
  EXPECT_EQ(picture["timestamp"]["nsec"], 500'000'000);
  image.size = 3;
  image.data.resize(3);
  EXPECT_EQ(foxglove::compressed_image(image, "LOCCAM_LEFT"), "") << "contradicts itself";

  pose_t pose{};
  pose.quat_odom_body_wxyz[0] = pose.quat_map_odom_wxyz[0] = 1.0;
  pose.position_odom_body_m[0] = 2.5;
  const json frames = json::parse(foxglove::frame_transforms(pose));
  EXPECT_EQ(frames["transforms"][1]["child_frame_id"], "body");
  EXPECT_EQ(frames["transforms"][1]["translation"]["x"], 2.5);
  pose.position_map_odom_m[1] = kNaN;
  EXPECT_EQ(foxglove::frame_transforms(pose), "");
}

}  // namespace
}  // namespace rover::interchange
