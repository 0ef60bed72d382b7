#include "tools/interchange/message_json.hpp"

#include <glib.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "common/core/check.hpp"

namespace rover::interchange {
namespace {

std::string value_text(const Field& field, size_t index) {
  if (const auto* texts = std::get_if<Field::Texts>(&field.values))
    return nlohmann::json((*texts)[index]).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  if (const auto* messages = std::get_if<Field::Messages>(&field.values)) return json_text((*messages)[index]);
  if (const auto* reals = std::get_if<Field::Reals>(&field.values); reals && !std::isfinite((*reals)[index]))
    return "null";
  return text_of(field, index);
}

// Values from `index` on, nested by the dimensions from `dimension` on.
std::string nested(const Field& field, size_t dimension, size_t& index) {
  if (dimension == field.shape.size()) return value_text(field, index++);
  std::string text = "[";
  for (int i = 0; i < field.shape[dimension]; ++i) text += (i > 0 ? "," : "") + nested(field, dimension + 1, index);
  return text + "]";
}

using json = nlohmann::ordered_json;

json schema_of(const std::string& type);

json schema_of_field(const FieldSchema& field) {
  if (field.type == "byte" && !field.dimensions.empty()) return {{"type", "string"}, {"contentEncoding", "base64"}};
  json schema;
  if (field.type == "float" || field.type == "double")
    schema = {{"type", "number"}};
  else if (field.type == "string")
    schema = {{"type", "string"}};
  else if (find_schema(field.type) != nullptr)
    schema = schema_of(field.type);
  else
    schema = {{"type", "integer"}};
  for (size_t i = 0; i < field.dimensions.size(); ++i) schema = {{"type", "array"}, {"items", schema}};
  return schema;
}

json schema_of(const std::string& type) {
  const MessageSchema* described = find_schema(type);
  ROVER_CHECK(described != nullptr, type);
  json properties = json::object();
  for (const FieldSchema& field : described->fields) properties[field.name] = schema_of_field(field);
  return {{"type", "object"}, {"properties", properties}};
}

}  // namespace

std::string base64(const void* data, size_t size) {
  const std::unique_ptr<gchar, decltype(&g_free)> text(g_base64_encode(static_cast<const guchar*>(data), size), g_free);
  return text.get();
}

std::string json_text(const Fields& fields) {
  std::string text = "{";
  for (const Field& field : fields) {
    text += (text.size() > 1 ? ",\"" : "\"") + field.name + "\":";
    const auto* bytes = std::get_if<Field::Bytes>(&field.values);
    if (bytes != nullptr && !field.shape.empty()) {
      text += "\"" + base64(bytes->data(), bytes->size()) + "\"";
    } else {
      size_t index = 0;
      text += nested(field, 0, index);
    }
  }
  return text + "}";
}

std::string json_schema(const std::string& type) {
  return schema_of(type).dump();
}

}  // namespace rover::interchange
