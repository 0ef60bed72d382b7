// Rows of cells, as tables and lists of poses come in text files.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rover::interchange {

// Passes over empty lines, those that begin with '#', and the head of a table, which often lacks its '#'. Takes any
// ends of lines, blanks around cells, and the mark of UTF-8 at the beginning. At most 64 MB.
class TextRows {
 public:
  // ',' parts cells, or ' ': any number of blanks and tabs. Throws ConfigError.
  TextRows(const std::string& file, char separator);

  // False after the last row.
  bool next();
  const std::vector<std::string_view>& cells() const { return cells_; }
  // The names of the columns, where the table has a head; known after next().
  const std::vector<std::string_view>& head() const { return head_; }
  // Not a number where the cell says nan; fails at other words.
  double number(size_t cell) const;
  // Throws ConfigError "FILE:LINE: what".
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
