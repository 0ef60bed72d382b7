// Changes single numbers of encoded messages, by the field's name in the .lcm file.
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

// The fields with a point that can be changed on the channel; empty where there are none.
std::vector<std::string> fields_of(const std::string& channel);
// The message with each number of the fields changed; as it was where it is not a message of the channel's type.
std::vector<std::uint8_t> change_fields(const FieldTarget& at, const std::function<double(double)>& change,
                                        std::vector<std::uint8_t> bytes);

}  // namespace rover
