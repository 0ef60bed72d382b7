// What every message type is made of, as lcm-gen reads lcmtypes/*.lcm.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rover {

struct FieldSchema {
  struct Dimension {
    int length = 0;            // of a fixed one
    std::string length_field;  // of the others: the integer field before it that holds the length
  };
  std::string name;
  std::string type;  // int8_t ... int64_t, float, double, byte, boolean, string or a message type without package
  std::vector<Dimension> dimensions;
};

struct MessageSchema {
  std::string type;
  std::vector<FieldSchema> fields;
};

// Null where there is no such type. Without package: "pose_t".
const MessageSchema* find_schema(const std::string& type);
// From the text that `lcm-gen --debug` writes.
std::vector<MessageSchema> parse_schemas(std::string_view text);

}  // namespace rover
