#include "tools/spy/field_lines.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/status/text_line.hpp"

namespace rover::spy {
namespace {

constexpr size_t kDigestValues = 4;
constexpr size_t kLineValues = 12;
constexpr size_t kLineMessages = 20;

std::string brief_value(const Field& field, size_t index) {
  if (const auto* reals = std::get_if<Field::Reals>(&field.values)) return fmt::format("{:.4g}", (*reals)[index]);
  if (std::holds_alternative<Field::Texts>(field.values)) return '"' + text_of(field, index) + '"';
  return text_of(field, index);
}

std::string digest_of(const Field& field) {
  if (std::holds_alternative<Field::Bytes>(field.values)) return fmt::format("{} B", field.size());
  const bool messages = std::holds_alternative<Field::Messages>(field.values);
  if (messages || field.size() > kDigestValues) return fmt::format("[{}]", field.size());
  if (field.shape.empty()) return brief_value(field, 0);
  std::string text;
  for (size_t i = 0; i < field.size(); ++i) text += (i == 0 ? "" : " ") + brief_value(field, i);
  return "[" + text + "]";
}

std::string type_text(const Field& field) {
  std::string text = field.type;
  for (const int length : field.shape) text += fmt::format("[{}]", length);
  return text;
}

std::string line(const std::string& indent, const Field& field, const std::string& values) {
  return fmt::format("{}{:<26} {:<14} {}", indent, field.name, type_text(field), values);
}

std::string values_text(const Field& field) {
  std::string text;
  for (size_t i = 0; i < std::min(field.size(), kLineValues); ++i)
    text += (i == 0 ? "" : " ") + status::printable(text_of(field, i));
  return field.size() > kLineValues ? fmt::format("{} ... ({} values)", text, field.size()) : text;
}

void add_lines(const std::string& indent, const Fields& fields, std::vector<std::string>& out);

void add_messages(const std::string& indent, const Field& field, std::vector<std::string>& out) {
  const auto& messages = std::get<Field::Messages>(field.values);
  for (size_t i = 0; i < std::min(messages.size(), kLineMessages); ++i) {
    out.push_back(line(indent, field, field.shape.empty() ? "" : fmt::format("#{}", i)));
    add_lines(indent + "  ", messages[i], out);
  }
  if (messages.size() > kLineMessages || messages.empty())
    out.push_back(line(indent, field, fmt::format("({} in total)", messages.size())));
}

void add_lines(const std::string& indent, const Fields& fields, std::vector<std::string>& out) {
  for (const Field& field : fields) {
    if (std::holds_alternative<Field::Messages>(field.values)) {
      add_messages(indent, field, out);
    } else {
      out.push_back(line(indent, field, values_text(field)));
    }
  }
}

}  // namespace

std::string digest(const Fields& fields) {
  std::string text;
  for (const Field& field : fields)
    if (field.name != "header") text += (text.empty() ? "" : " ") + field.name + "=" + digest_of(field);
  return status::printable(text);
}

std::vector<std::string> field_lines(const Fields& fields) {
  std::vector<std::string> lines;
  add_lines("  ", fields, lines);
  return lines;
}

}  // namespace rover::spy
