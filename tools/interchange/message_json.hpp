// Messages as JSON, and the JSON schema of a message type.
#pragma once

#include <string>

#include "common/bus/message_fields.hpp"

namespace rover::interchange {

// Fields by name; arrays as arrays, bytes in base64, numbers that are not finite as null.
std::string json_text(const Fields& fields);
// JSON schema (draft-07) of json_text's output for a type.
std::string json_schema(const std::string& type);

std::string base64(const void* data, size_t size);

}  // namespace rover::interchange
