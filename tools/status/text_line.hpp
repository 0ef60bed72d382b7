// Lines of a terminal: pieces of text with a colour, cut at a width that colours do not count in.
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
// Without blanks at the end. `colours`: with the terminal's codes.
std::string rendered(const Line& line, size_t columns, bool colours);

// Filled with blanks, or cut: to the left or right side of a field.
std::string left(const std::string& text, size_t field);
std::string right(const std::string& text, size_t field);
// With so many decimals; "-" where the value is not finite.
std::string fixed(double value, int decimals);
// With at most four digits that count.
std::string brief(double value);
// Whatever a service says: one line of plain characters, nothing that the terminal obeys.
std::string printable(const std::string& text);

}  // namespace rover::status
