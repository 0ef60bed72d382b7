#include "common/bus/message_schema.hpp"

#include <map>
#include <sstream>

#include "common/core/check.hpp"

// The assembler takes the file's bytes as they are. ROVER_SCHEMA_FILE: what lcm-gen made of all types.
__asm__(".pushsection .rodata\nrover_schema_begin:\n.incbin \"" ROVER_SCHEMA_FILE
        "\"\nrover_schema_end:\n.byte 0\n.popsection\n");
// Hidden: GNU ld for arm64 drops the offset of a local symbol that is reached through the GOT.
extern "C" [[gnu::visibility("hidden")]] const char rover_schema_begin[];
extern "C" [[gnu::visibility("hidden")]] const char rover_schema_end[];

namespace rover {
namespace {

std::string without_package(const std::string& type) {
  return type.substr(type.rfind('.') + 1);
}

// "[ (const) 6 ]" or "[ (var) point_count ]", its bracket taken already.
FieldSchema::Dimension parse_dimension(std::istringstream& words) {
  std::string kind, length, bracket;
  words >> kind >> length >> bracket;
  ROVER_CHECK(bracket == "]", kind, length);
  return kind == "(const)" ? FieldSchema::Dimension{std::stoi(length), ""} : FieldSchema::Dimension{0, length};
}

FieldSchema parse_field(const std::string& line) {
  std::istringstream words(line);
  FieldSchema field;
  words >> field.type >> field.name;
  field.type = without_package(field.type);
  for (std::string bracket; words >> bracket;) field.dimensions.push_back(parse_dimension(words));
  return field;
}

}  // namespace

std::vector<MessageSchema> parse_schemas(std::string_view text) {
  const std::string struct_line = "struct ";
  std::vector<MessageSchema> schemas;
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(struct_line)) {
      const std::string name = line.substr(struct_line.size(), line.find(' ', struct_line.size()) - struct_line.size());
      schemas.push_back({without_package(name), {}});
    } else if (line.starts_with('\t') && !schemas.empty()) {
      schemas.back().fields.push_back(parse_field(line));
    }
  }
  return schemas;
}

const MessageSchema* find_schema(const std::string& type) {
  static const std::map<std::string, MessageSchema> kSchemas = [] {
    std::map<std::string, MessageSchema> by_type;
    const auto size = static_cast<size_t>(rover_schema_end - rover_schema_begin);
    for (MessageSchema& schema : parse_schemas({rover_schema_begin, size}))
      by_type.emplace(schema.type, std::move(schema));
    return by_type;
  }();
  const auto it = kSchemas.find(type);
  return it == kSchemas.end() ? nullptr : &it->second;
}

}  // namespace rover
