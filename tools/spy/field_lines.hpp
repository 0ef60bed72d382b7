// Formats the fields of a message as text.
#pragma once

#include <string>
#include <vector>

#include "common/bus/message_fields.hpp"

namespace rover::spy {

// One line without the header, reals with 4 digits: "status=0 position_m=[0.08 0 0.001] data=196608 B".
std::string digest(const Fields& fields);
// One line for each field with all digits: name, type and shape, values. Long arrays are truncated.
std::vector<std::string> field_lines(const Fields& fields);

}  // namespace rover::spy
