#include "common/bus/message_fields.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <map>
#include <type_traits>

#include "common/bus/channel_types.hpp"
#include "common/bus/streams.hpp"
#include "common/core/check.hpp"

namespace rover {
namespace {

// Reads the big-endian bytes of a message. After the end it is bad and returns zeros.
class Reader {
 public:
  Reader(const void* data, size_t size) : at_(static_cast<const std::uint8_t*>(data)), left_(size) {}

  template <class Integer>
  Integer integer() {
    std::make_unsigned_t<Integer> value = 0;
    if (!take(sizeof(Integer))) return 0;
    for (size_t i = 0; i < sizeof(Integer); ++i)
      value = static_cast<std::make_unsigned_t<Integer>>((std::uint64_t{value} << 8U) | taken_[i]);
    return static_cast<Integer>(value);
  }
  // Its length counts the zero at its end.
  std::string text() {
    const size_t length = pass_text();
    if (length == 0) return {};
    return {reinterpret_cast<const char*>(taken_), length - 1};
  }
  size_t pass_text() {
    const auto length = integer<std::int32_t>();
    if (length >= 1 && take(static_cast<size_t>(length))) return static_cast<size_t>(length);
    fail();
    return 0;
  }
  // An integer of so many bytes.
  std::int64_t number(size_t bytes) {
    std::uint64_t value = 0;
    if (!take(bytes)) return 0;
    for (size_t i = 0; i < bytes; ++i) value = (value << 8U) | taken_[i];
    const size_t unused_bits = 64 - 8 * bytes;
    return static_cast<std::int64_t>(value << unused_bits) >> unused_bits;
  }
  void pass(size_t count) { take(count); }
  Field::Bytes bytes(size_t count) {
    if (!take(count)) return {};
    return {taken_, taken_ + count};
  }
  void fail() { good_ = false; }
  bool good() const { return good_; }
  size_t left() const { return left_; }

 private:
  bool take(size_t count) {
    good_ = good_ && count <= left_;
    if (!good_) return false;
    taken_ = at_;
    at_ += count;
    left_ -= count;
    return true;
  }

  const std::uint8_t* at_;
  const std::uint8_t* taken_ = nullptr;
  size_t left_;
  bool good_ = true;
};

template <class Value, class Read>
std::vector<Value> read_all(Reader& reader, size_t count, Read read) {
  std::vector<Value> values;
  // A damaged length fails at the end of the bytes, before it allocates memory.
  for (size_t i = 0; i < count && reader.good(); ++i) values.push_back(read());
  return values;
}

using Lengths = std::map<std::string, std::int64_t>;  // by the names of the fields that hold them

// Number of values; negative lengths count as 0.
size_t length_of(const FieldSchema::Dimension& dimension, Lengths& lengths, Reader& reader) {
  constexpr std::int64_t kMax = std::int64_t{1} << 31;
  const std::int64_t length = dimension.length_field.empty() ? dimension.length : lengths[dimension.length_field];
  if (length < 0) reader.fail();
  return static_cast<size_t>(std::clamp<std::int64_t>(length, 0, kMax));
}

// Saturates far above the size of any message, so that the product does not overflow.
size_t product(size_t count, size_t length) {
  constexpr size_t kMax = size_t{1} << 32;
  return std::min(count * length, kMax);
}

Fields read_message(Reader& reader, const MessageSchema& schema);

void read_values(Reader& reader, size_t count, Field& field) {
  const auto integers = [&]<class Integer>(Integer) {
    field.values = read_all<std::int64_t>(reader, count, [&] { return reader.integer<Integer>(); });
  };
  const std::string& type = field.type;
  if (type == "int8_t" || type == "boolean") return integers(std::int8_t{});
  if (type == "int16_t") return integers(std::int16_t{});
  if (type == "int32_t") return integers(std::int32_t{});
  if (type == "int64_t") return integers(std::int64_t{});
  if (type == "byte") {
    field.values = reader.bytes(count);
  } else if (type == "float") {
    field.values =
        read_all<double>(reader, count, [&] { return std::bit_cast<float>(reader.integer<std::int32_t>()); });
  } else if (type == "double") {
    field.values =
        read_all<double>(reader, count, [&] { return std::bit_cast<double>(reader.integer<std::int64_t>()); });
  } else if (type == "string") {
    field.values = read_all<std::string>(reader, count, [&] { return reader.text(); });
  } else {
    const MessageSchema* schema = find_schema(type);
    ROVER_CHECK(schema != nullptr, type);
    field.values = read_all<Fields>(reader, count, [&] { return read_message(reader, *schema); });
  }
}

Fields read_message(Reader& reader, const MessageSchema& schema) {
  Fields fields;
  Lengths lengths;
  for (const FieldSchema& described : schema.fields) {
    Field field{described.name, described.type, {}, {}};
    size_t count = 1;
    for (const FieldSchema::Dimension& dimension : described.dimensions) {
      const size_t length = length_of(dimension, lengths, reader);
      if (!reader.good()) return fields;
      field.shape.push_back(static_cast<int>(length));
      count = product(count, length);
    }
    read_values(reader, count, field);
    const auto* integers = std::get_if<Field::Integers>(&field.values);
    if (integers != nullptr && integers->size() == 1) lengths[field.name] = integers->front();
    fields.push_back(std::move(field));
  }
  return fields;
}

// Of a plain value; 0: a text, or a message of another type.
size_t bytes_of(const std::string& type) {
  if (type == "int8_t" || type == "boolean" || type == "byte") return 1;
  if (type == "int16_t") return 2;
  if (type == "int32_t" || type == "float") return 4;
  return type == "int64_t" || type == "double" ? 8 : 0;
}

// Checks a message without building it.
void pass_message(Reader& reader, const MessageSchema& schema) {
  Lengths lengths;
  for (const FieldSchema& field : schema.fields) {
    size_t count = 1;
    for (const FieldSchema::Dimension& dimension : field.dimensions)
      count = product(count, length_of(dimension, lengths, reader));
    const size_t bytes = bytes_of(field.type);
    if (bytes > 0 && field.dimensions.empty()) {
      lengths[field.name] = reader.number(bytes);
    } else if (bytes > 0) {
      reader.pass(count * bytes);
    } else {
      const MessageSchema* inner = find_schema(field.type);
      for (size_t i = 0; i < count && reader.good(); ++i) {
        if (inner == nullptr) {
          reader.pass_text();
        } else {
          pass_message(reader, *inner);
        }
      }
    }
    if (!reader.good()) return;
  }
}

template <class Number>
std::string shortest(Number value) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end.ptr};
}

// "[1][2]" for the value at `index` of a field of this shape.
std::string subscript(const std::vector<int>& shape, size_t index) {
  std::string text;
  for (auto length = shape.rbegin(); length != shape.rend(); ++length) {
    const auto size = static_cast<size_t>(*length);
    text = "[" + std::to_string(index % size) + "]" + text;
    index /= size;
  }
  return text;
}

void visit(const std::string& prefix, const Fields& fields, const std::function<void(const Leaf&)>& take) {
  for (const Field& field : fields) {
    const auto* messages = std::get_if<Field::Messages>(&field.values);
    for (size_t i = 0; i < field.size(); ++i) {
      const std::string path = prefix + field.name + subscript(field.shape, i);
      if (messages == nullptr) {
        take({path, field, i});
      } else {
        visit(path + ".", (*messages)[i], take);
      }
    }
  }
}

}  // namespace

size_t Field::size() const {
  return std::visit([](const auto& all) { return all.size(); }, values);
}

std::optional<Fields> decode_fields(const std::string& channel, const void* data, int size) {
  const ChannelType* type = find_channel_type(channel);
  if (type == nullptr || peek_fingerprint(data, size) != type->fingerprint) return std::nullopt;
  const MessageSchema* schema = find_schema(type->name);
  ROVER_CHECK(schema != nullptr, type->name);
  Reader reader(data, static_cast<size_t>(size));
  reader.integer<std::int64_t>();
  Fields fields = read_message(reader, *schema);
  if (!reader.good() || reader.left() > 0) return std::nullopt;
  return fields;
}

bool is_whole_message(const std::string& type, const void* data, int size) {
  const MessageSchema* schema = find_schema(type);
  ROVER_CHECK(schema != nullptr, type);
  Reader reader(data, static_cast<size_t>(size));
  reader.integer<std::int64_t>();
  pass_message(reader, *schema);
  return reader.good() && reader.left() == 0;
}

std::string text_of(const Field& field, size_t index) {
  if (const auto* texts = std::get_if<Field::Texts>(&field.values)) return texts->at(index);
  if (const auto* integers = std::get_if<Field::Integers>(&field.values)) return std::to_string(integers->at(index));
  if (const auto* bytes = std::get_if<Field::Bytes>(&field.values)) return std::to_string(bytes->at(index));
  const double value = std::get<Field::Reals>(field.values).at(index);
  if (std::isnan(value)) return "nan";  // without the sign bit, which depends on the processor
  return field.type == "float" ? shortest(static_cast<float>(value)) : shortest(value);
}

void visit_leaves(const Fields& fields, const std::function<void(const Leaf&)>& take) {
  visit("", fields, take);
}

}  // namespace rover
