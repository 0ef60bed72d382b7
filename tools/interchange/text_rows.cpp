#include "tools/interchange/text_rows.hpp"

#include <algorithm>
#include <cctype>

#include "common/bus/config.hpp"
#include "common/bus/text_file.hpp"
#include "common/core/decimal.hpp"
#include "common/core/frames.hpp"

namespace rover::interchange {
namespace {

constexpr size_t kMaxTextBytes = 64 << 20;  // hours of ground truth at 200 Hz
constexpr const char* kBlanks = " \t\r";

std::string_view trimmed(std::string_view text) {
  const size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

}  // namespace

TextRows::TextRows(const std::string& file, char separator)
    : file_(file), separator_(separator), text_(read_text(file, kMaxTextBytes)) {}

bool TextRows::next() {
  while (at_ < text_.size()) {
    const size_t end = std::min(text_.find('\n', at_), text_.size());
    const std::string_view row = trimmed(std::string_view(text_).substr(at_, end - at_));
    at_ = end + 1;
    ++line_;
    if (row.empty()) continue;
    split(row);
    if (is_head(row)) {
      if (head_.empty()) head_ = cells_;
    } else {
      in_rows_ = true;
      return true;
    }
  }
  return false;
}

bool TextRows::is_head(std::string_view row) const {
  return row.front() == '#' ||
         (separator_ == ',' && !in_rows_ && head_.empty() && std::isalpha(static_cast<unsigned char>(row.front())));
}

void TextRows::split(std::string_view row) {
  const std::string_view separators = separator_ == ' ' ? " \t" : ",";
  cells_.clear();
  while (true) {
    const size_t end = row.find_first_of(separators);
    cells_.push_back(trimmed(row.substr(0, end)));
    if (end == std::string_view::npos) return;
    row = separator_ == ' ' ? trimmed(row.substr(end)) : row.substr(end + 1);
  }
}

double TextRows::number(size_t cell) const {
  const std::string_view text = cells_[cell];
  if (text == "nan" || text == "NaN" || text == "-nan") return kNaN;
  const auto value = parse_number(text);
  if (!value) fail("'" + std::string(text.substr(0, 40)) + "' is not a number");
  return *value;
}

void TextRows::fail(const std::string& what) const {
  throw ConfigError(file_ + ":" + std::to_string(line_) + ": " + what);
}

}  // namespace rover::interchange
