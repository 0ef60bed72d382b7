// The fields of a message as text.
#pragma once

#include <string>
#include <vector>

#include "common/bus/message_fields.hpp"

namespace rover::spy {

// All but the header in one line, reals with four digits: "status=0 position_m=[0.08 0 0.001] data=196608 B".
std::string digest(const Fields& fields);
// One line a field, with all digits: name, type and shape, values; long arrays are cut and counted.
std::vector<std::string> field_lines(const Fields& fields);

}  // namespace rover::spy
