// Reads rows of cells from text files: tables and lists of poses.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rover::interchange {

// Skips empty lines, '#' comments and a header. Accepts any line ends, blanks around cells, a UTF-8 byte order mark. At
// most 64 MB.
class TextRows {
 public:
  // `separator`: ',' or ' ' (any blanks and tabs). Throws ConfigError.
  TextRows(const std::string& file, char separator);

  // Returns false after the last row.
  bool next();
  const std::vector<std::string_view>& cells() const { return cells_; }
  // Column names, if the table has a header; valid after next().
  const std::vector<std::string_view>& head() const { return head_; }
  // NaN if the cell is "nan"; fails for other words.
  double number(size_t cell) const;
  // Throws ConfigError "FILE:LINE: reason".
  [[noreturn]] void fail(const std::string& what) const;

 private:
  bool is_head(std::string_view row) const;
  void split(std::string_view row);

  std::string file_;
  char separator_;
  std::string text_;
  size_t at_ = 0;
  int line_ = 0;
  bool in_rows_ = false;
  std::vector<std::string_view> head_;
  std::vector<std::string_view> cells_;
};

}  // namespace rover::interchange
