// Lines of coloured text, truncated at a width that does not count colour codes.
#pragma once

#include <string>
#include <vector>

namespace rover::status {

enum class Colour { kPlain, kBold, kYellow, kRed };

struct Piece {
  std::string text;
  Colour colour = Colour::kPlain;
};

using Line = std::vector<Piece>;

size_t width(const Line& line);
// Without trailing spaces. `colours`: with terminal codes.
std::string rendered(const Line& line, size_t columns, bool colours);

// Pads or truncates to the field width, aligned left or right.
std::string left(const std::string& text, size_t field);
std::string right(const std::string& text, size_t field);
// With this number of decimals; "-" if not finite.
std::string fixed(double value, int decimals);
// With at most four significant digits.
std::string brief(double value);
// Replaces control characters: text from the bus must not control the terminal.
std::string printable(const std::string& text);

}  // namespace rover::status
