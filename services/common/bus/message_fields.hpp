// Any message as a tree of fields, for tools that do not know its type.
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

// Empty for an unknown channel, or if the bytes are not one whole message of its type.
std::optional<Fields> decode_fields(const std::string& channel, const void* data, int size);

// Whether the bytes, without the fingerprint, are one whole message of the type ("pose_t"). Unlike lcm-gen's decoders
// it allocates no memory for damaged lengths.
bool is_whole_message(const std::string& type, const void* data, int size);

// Reals have the fewest digits that round-trip. Not for fields that are messages.
std::string text_of(const Field& field, size_t index);

// A single number or text of a message: "header.seq", "position_m[0]", "inputs[2].gaps".
struct Leaf {
  std::string path;
  const Field& field;
  size_t index;  // into its values
};
void visit_leaves(const Fields& fields, const std::function<void(const Leaf&)>& take);

}  // namespace rover
