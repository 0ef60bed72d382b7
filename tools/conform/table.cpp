#include "tools/conform/table.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace rover::conform {
namespace {

std::string word(Verdict verdict, bool colours) {
  const char* text = verdict == Verdict::kPass ? "pass" : verdict == Verdict::kFail ? "FAIL" : "-";
  const std::string padded = fmt::format("{:<4}", text);
  if (!colours || verdict == Verdict::kSkipped) return padded;
  return (verdict == Verdict::kPass ? "\033[32m" : "\033[31m") + padded + "\033[0m";
}

}  // namespace

std::string table(const std::vector<Line>& lines, bool colours) {
  size_t check = 0;
  size_t measured = 0;
  for (const Line& l : lines) {
    check = std::max(check, l.check.size());
    measured = std::max(measured, std::min<size_t>(l.measured.size(), 60));
  }
  std::string out;
  for (const Line& l : lines)
    out += fmt::format("{}  {:<{}}  {:<{}}  {}\n", word(l.verdict, colours), l.check, check, l.measured, measured,
                       l.requirement.empty() ? "" : "required: " + l.requirement);
  return out;
}

int failures(const std::vector<Line>& lines) {
  return static_cast<int>(
      std::count_if(lines.begin(), lines.end(), [](const Line& l) { return l.verdict == Verdict::kFail; }));
}

}  // namespace rover::conform
