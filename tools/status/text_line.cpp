#include "tools/status/text_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rover::status {
namespace {

const char* code_of(Colour colour) {
  switch (colour) {
    case Colour::kBold:
      return "\033[1m";
    case Colour::kYellow:
      return "\033[33m";
    case Colour::kRed:
      return "\033[31m";
    default:
      return "";
  }
}

Line without_trailing_blanks(Line line) {
  while (!line.empty()) {
    std::string& text = line.back().text;
    text.erase(text.find_last_not_of(' ') + 1);
    if (!text.empty()) break;
    line.pop_back();
  }
  return line;
}

}  // namespace

size_t width(const Line& line) {
  size_t sum = 0;
  for (const Piece& piece : line) sum += piece.text.size();
  return sum;
}

std::string rendered(const Line& line, size_t columns, bool colours) {
  Line cut;
  for (size_t used = 0; const Piece& piece : line) {
    cut.push_back({piece.text.substr(0, columns - used), piece.colour});
    used += cut.back().text.size();
  }
  std::string out;
  for (const Piece& piece : without_trailing_blanks(std::move(cut))) {
    const bool coloured = colours && piece.colour != Colour::kPlain;
    out += coloured ? code_of(piece.colour) + piece.text + "\033[0m" : piece.text;
  }
  return out;
}

std::string left(const std::string& text, size_t field) {
  return fmt::format("{:<{}}", text.substr(0, field), field);
}

std::string right(const std::string& text, size_t field) {
  return fmt::format("{:>{}}", text.substr(0, field), field);
}

std::string fixed(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "-";
}

std::string brief(double value) {
  return std::isfinite(value) ? fmt::format("{:.4g}", value) : "-";
}

std::string printable(const std::string& text) {
  std::string out = text;
  std::replace_if(
      out.begin(), out.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return out;
}

}  // namespace rover::status
