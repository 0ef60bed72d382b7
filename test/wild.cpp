#include "wild.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>

namespace rover {
namespace {

// Table cell: one line, with escaped separators.
std::string cell(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  std::replace(text.begin(), text.end(), '\t', ' ');
  std::replace(text.begin(), text.end(), '|', '/');
  return text;
}

}  // namespace

void wild_row(const std::string& kind, const std::string& input, const std::string& before, const std::string& now) {
  const char* file = std::getenv("ROVER_WILD_ROWS");
  if (file == nullptr) return;
  std::ofstream(file, std::ios::app) << cell(kind) + "\t" + cell(input) + "\t" + cell(before) + "\t" + cell(now) + "\n";
}

}  // namespace rover
