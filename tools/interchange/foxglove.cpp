#include "tools/interchange/foxglove.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "common/bus/convert.hpp"
#include "common/core/time.hpp"
#include "tools/interchange/message_json.hpp"

namespace rover::interchange::foxglove {
namespace {

using json = nlohmann::ordered_json;

json object(const json& properties) {
  return {{"type", "object"}, {"properties", properties}};
}

json stamp_schema() {
  return object({{"sec", {{"type", "integer"}}}, {"nsec", {{"type", "integer"}}}});
}

json numbers_schema(std::initializer_list<const char*> names) {
  json properties = json::object();
  for (const char* name : names) properties[name] = {{"type", "number"}};
  return object(properties);
}

json stamp(Utime utime) {
  return {{"sec", utime / 1'000'000}, {"nsec", utime % 1'000'000 * 1'000}};
}

json transform(Utime utime, const char* parent, const char* child, const Eigen::Isometry3d& T) {
  const Eigen::Vector3d p = T.translation();
  const Eigen::Quaterniond q(T.linear());
  return {{"timestamp", stamp(utime)},
          {"parent_frame_id", parent},
          {"child_frame_id", child},
          {"translation", {{"x", p.x()}, {"y", p.y()}, {"z", p.z()}}},
          {"rotation", {{"x", q.x()}, {"y", q.y()}, {"z", q.z()}, {"w", q.w()}}}};
}

}  // namespace

std::string schema(const std::string& name) {
  const json text = {{"type", "string"}};
  const json integer = {{"type", "integer"}};
  const json data = {{"type", "string"}, {"contentEncoding", "base64"}};
  if (name == kCompressedImage)
    return object({{"timestamp", stamp_schema()}, {"frame_id", text}, {"data", data}, {"format", text}}).dump();
  if (name == kRawImage)
    return object({{"timestamp", stamp_schema()},
                   {"frame_id", text},
                   {"width", integer},
                   {"height", integer},
                   {"encoding", text},
                   {"step", integer},
                   {"data", data}})
        .dump();
  const json one = object({{"timestamp", stamp_schema()},
                           {"parent_frame_id", text},
                           {"child_frame_id", text},
                           {"translation", numbers_schema({"x", "y", "z"})},
                           {"rotation", numbers_schema({"x", "y", "z", "w"})}});
  return object({{"transforms", {{"type", "array"}, {"items", one}}}}).dump();
}

std::string compressed_image(const image_t& message, const std::string& frame) {
  GrayImage image = image_from(message);
  if (image.data.empty()) return {};
  std::vector<std::uint8_t> png;
  cv::imencode(".png", cv::Mat(image.height, image.width, CV_8UC1, image.data.data()), png);
  return json{{"timestamp", stamp(message.header.utime)},
              {"frame_id", frame},
              {"data", base64(png.data(), png.size())},
              {"format", "png"}}
      .dump();
}

std::string raw_image(const disparity_t& message, const std::string& frame) {
  Disparity disparity = disparity_from(message);
  if (disparity.px16.empty()) return {};
  for (std::int16_t& value : disparity.px16) value = std::max<std::int16_t>(value, 0);
  return json{{"timestamp", stamp(message.header.utime)},
              {"frame_id", frame},
              {"width", disparity.width},
              {"height", disparity.height},
              {"encoding", "16UC1"},
              {"step", 2 * disparity.width},
              {"data", base64(disparity.px16.data(), 2 * disparity.px16.size())}}
      .dump();
}

std::string frame_transforms(const pose_t& message) {
  const Eigen::Isometry3d T_map_odom = pose_from(message.position_map_odom_m, message.quat_map_odom_wxyz);
  const Eigen::Isometry3d T_odom_body = pose_from(message.position_odom_body_m, message.quat_odom_body_wxyz);
  if (!is_finite(T_map_odom) || !is_finite(T_odom_body)) return {};
  const Utime utime = message.header.utime;
  return json{
      {"transforms", {transform(utime, "map", "odom", T_map_odom), transform(utime, "odom", "body", T_odom_body)}}}
      .dump();
}

}  // namespace rover::interchange::foxglove
