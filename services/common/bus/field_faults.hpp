// Changes values of encoded messages by the field's name in the .lcm file.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace rover {

// "CHANNEL.field", or "CHANNEL" for all of its fields.
struct FieldTarget {
  std::string channel;
  std::string field;
};
FieldTarget split_field(const std::string& target);

// The floating-point fields of the channel that can be changed.
std::vector<std::string> fields_of(const std::string& channel);
// Applies the change to each value of the fields. Messages of another type remain unchanged.
std::vector<std::uint8_t> change_fields(const FieldTarget& at, const std::function<double(double)>& change,
                                        std::vector<std::uint8_t> bytes);

}  // namespace rover
