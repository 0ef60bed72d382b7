// Parses plain decimal numbers of files and arguments.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace rover {

// Both parse the whole text, with at most one sign. Nothing if characters remain, the value does not fit, or a leading
// zero could mean octal.

// 0.5, -3, 1e-3. No hexadecimal; "nan" and "inf" are not numbers.
std::optional<double> parse_number(std::string_view text);
// 42, -7. No fraction, no exponent.
std::optional<std::int64_t> parse_whole_number(std::string_view text);

}  // namespace rover
