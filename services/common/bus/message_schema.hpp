// Fields of each message type, as lcm-gen reads lcmtypes/*.lcm.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rover {

struct FieldSchema {
  struct Dimension {
    int length = 0;            // of a fixed one
    std::string length_field;  // else the preceding integer field with the length
  };
  std::string name;
  std::string type;  // int8_t ... int64_t, float, double, byte, boolean, string or a message type without package
  std::vector<Dimension> dimensions;
};

struct MessageSchema {
  std::string type;
  std::vector<FieldSchema> fields;
};

// Null if there is no such type. Without package: "pose_t".
const MessageSchema* find_schema(const std::string& type);
// Parses the output of `lcm-gen --debug`.
std::vector<MessageSchema> parse_schemas(std::string_view text);

}  // namespace rover
