#include "tools/interchange/csv_table.hpp"

#include <algorithm>
#include <map>

#include "common/core/check.hpp"

namespace rover::interchange {
namespace {

bool varies(const FieldSchema& field) {
  return std::any_of(field.dimensions.begin(), field.dimensions.end(),
                     [](const FieldSchema::Dimension& dimension) { return !dimension.length_field.empty(); });
}

// Pixels have no column.
bool is_pixels(const FieldSchema& field) {
  return field.type == "byte" || (field.type == "int16_t" && varies(field));
}

// "", or "[0]", "[1]" ...; "[0][0]", "[0][1]" ...
std::vector<std::string> subscripts(const FieldSchema& field) {
  std::vector<std::string> all = {""};
  for (const FieldSchema::Dimension& dimension : field.dimensions) {
    std::vector<std::string> longer;
    for (const std::string& one : all)
      for (int i = 0; i < dimension.length; ++i) longer.push_back(one + "[" + std::to_string(i) + "]");
    all = std::move(longer);
  }
  return all;
}

void add_columns(const std::string& prefix, const std::string& type, bool in_list, std::vector<std::string>& columns) {
  const MessageSchema* schema = find_schema(type);
  ROVER_CHECK(schema != nullptr, type);
  for (const FieldSchema& field : schema->fields) {
    if (is_pixels(field)) continue;
    const bool list = in_list || varies(field);
    const bool is_message = find_schema(field.type) != nullptr;
    for (const std::string& subscript : list ? std::vector<std::string>{""} : subscripts(field)) {
      const std::string path = prefix + field.name + subscript;
      if (is_message)
        add_columns(path + ".", field.type, list, columns);
      else
        columns.push_back(path);
    }
  }
}

// Column of a leaf: "inputs[2].gaps" goes to "inputs.gaps" if no column has the full path.
std::string without_subscripts(const std::string& path) {
  std::string column;
  int depth = 0;
  for (const char c : path) {
    if (c == '[') ++depth;
    if (depth == 0) column += c;
    if (c == ']') --depth;
  }
  return column;
}

std::string csv_cell(const std::string& cell) {
  if (cell.find_first_of(",\"\r\n") == std::string::npos) return cell;
  std::string text = "\"";
  for (const char c : cell) text += c == '"' ? "\"\"" : std::string(1, c);
  return text + "\"";
}

}  // namespace

std::vector<std::string> csv_columns(const std::string& type) {
  std::vector<std::string> columns;
  add_columns("", type, false, columns);
  return columns;
}

void write_csv_header(std::ostream& out, const std::vector<std::string>& columns) {
  for (size_t i = 0; i < columns.size(); ++i) out << (i > 0 ? "," : "") << columns[i];
  out << "\r\n";
}

void write_csv_row(std::ostream& out, const std::vector<std::string>& columns, const Fields& fields) {
  std::map<std::string, std::string> cells;
  for (const std::string& column : columns) cells[column];
  Fields kept;
  for (const Field& field : fields)
    if (field.type != "byte" && (field.type != "int16_t" || field.size() == 1)) kept.push_back(field);
  visit_leaves(kept, [&](const Leaf& leaf) {
    auto cell = cells.find(leaf.path);
    if (cell == cells.end()) cell = cells.find(without_subscripts(leaf.path));
    if (cell == cells.end()) return;
    if (!cell->second.empty()) cell->second += ' ';
    cell->second += text_of(leaf.field, leaf.index);
  });
  for (size_t i = 0; i < columns.size(); ++i) out << (i > 0 ? "," : "") << csv_cell(cells[columns[i]]);
  out << "\r\n";
}

}  // namespace rover::interchange
