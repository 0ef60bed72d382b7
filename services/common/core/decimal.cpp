#include "common/core/decimal.hpp"

#include <charconv>
#include <cmath>

namespace rover {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

// std::from_chars does not accept "+".
std::string_view without_plus(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  return text;
}

bool has_leading_zero(std::string_view text) {
  if (!text.empty() && text[0] == '-') text.remove_prefix(1);
  return text.size() > 1 && text[0] == '0' && is_digit(text[1]);
}

template <class T>
std::optional<T> parse(std::string_view typed) {
  const std::string_view text = without_plus(typed);
  if (has_leading_zero(text)) return std::nullopt;
  T value{};
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || rest != end) return std::nullopt;
  return value;
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
  const auto value = parse<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<std::int64_t> parse_whole_number(std::string_view text) {
  return parse<std::int64_t>(text);
}

}  // namespace rover
