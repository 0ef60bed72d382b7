// Any message as a tree of its fields, for tools that show or export what they do not know by type.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common/bus/message_schema.hpp"

namespace rover {

struct Field;
using Fields = std::vector<Field>;

struct Field {
  using Integers = std::vector<std::int64_t>;  // int8_t ... int64_t, boolean
  using Reals = std::vector<double>;           // float, double
  using Texts = std::vector<std::string>;
  using Bytes = std::vector<std::uint8_t>;  // byte
  using Messages = std::vector<Fields>;     // of another type

  std::string name;
  std::string type;        // as in FieldSchema
  std::vector<int> shape;  // empty: a single value; else the length of each dimension
  std::variant<Integers, Reals, Texts, Bytes, Messages> values;  // last index fastest

  size_t size() const;
};

// Empty where the bytes are not one whole message of the type that the channel carries, and for unknown channels.
std::optional<Fields> decode_fields(const std::string& channel, const void* data, int size);

// Whether the bytes are one whole message of the type ("pose_t"), its fingerprint aside. Unlike lcm-gen's decoders it
// takes no memory for lengths that damaged bytes claim.
bool is_whole_message(const std::string& type, const void* data, int size);

// Integers and texts as they are, reals with the fewest digits that read back as the same number. Not for messages.
std::string text_of(const Field& field, size_t index);

// A single number or text of a message: "header.seq", "position_m[0]", "inputs[2].gaps".
struct Leaf {
  std::string path;
  const Field& field;
  size_t index;  // into its values
};
void visit_leaves(const Fields& fields, const std::function<void(const Leaf&)>& take);

}  // namespace rover
