// Numbers as text, from files and arguments: plain decimal, the same in every place.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace rover {

// Both take the whole text, with at most one sign; nothing where a part is left over, where the value does not fit, or
// where a leading zero leaves open whether it is octal.

// 0.5, -3, 1e-3. No hexadecimal; "nan" and "inf" are no numbers.
std::optional<double> parse_number(std::string_view text);
// 42, -7. No fraction, no exponent.
std::optional<std::int64_t> parse_whole_number(std::string_view text);

}  // namespace rover
