#include "tools/campaign/progress_line.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <ctime>

namespace rover::campaign {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kTerminalPeriod{1}, kFilePeriod{60};

// Time of day of the expected end; with the date if it is not today.
std::string end_text(double remaining_s) {
  const std::time_t now = std::time(nullptr);
  const std::time_t end = now + static_cast<std::time_t>(remaining_s);
  const std::tm today = *std::localtime(&now);
  const std::tm day = *std::localtime(&end);
  char text[32];
  std::strftime(text, sizeof text, day.tm_yday == today.tm_yday ? "%H:%M" : "%Y-%m-%d %H:%M", &day);
  return text;
}

}  // namespace

std::string duration_text(double seconds) {
  const auto s = static_cast<long>(seconds + 0.5);
  if (s >= 3600) return fmt::format("{} h {:02} min", s / 3600, s % 3600 / 60);
  if (s >= 60) return fmt::format("{} min {:02} s", s / 60, s % 60);
  return fmt::format("{} s", s);
}

std::string progress_text(std::int64_t rows, std::int64_t jobs, std::int64_t new_rows, double elapsed_s) {
  std::string text = fmt::format("{} of {} drives ({:.0f} %)", rows, jobs,
                                 100.0 * static_cast<double>(rows) / static_cast<double>(jobs));
  if (rows == jobs || new_rows == 0) return text;
  const double remaining_s = elapsed_s * static_cast<double>(jobs - rows) / static_cast<double>(new_rows);
  return text + fmt::format(", {} left, ends at {}", duration_text(remaining_s), end_text(remaining_s));
}

ProgressLine::ProgressLine(std::int64_t rows, std::int64_t jobs)
    : first_rows_(rows), jobs_(jobs), terminal_(isatty(STDOUT_FILENO) != 0), start_(Clock::now()) {}

void ProgressLine::show(std::int64_t rows) {
  if (!printed_ || Clock::now() - *printed_ >= (terminal_ ? kTerminalPeriod : kFilePeriod)) print(rows, false);
}

void ProgressLine::finish(std::int64_t rows) {
  print(rows, true);
}

void ProgressLine::print(std::int64_t rows, bool last) {
  printed_ = Clock::now();
  const double elapsed_s = std::chrono::duration<double>(*printed_ - start_).count();
  const std::string text = progress_text(rows, jobs_, rows - first_rows_, elapsed_s);
  std::printf(terminal_ ? "\r\033[K%s%s" : "%s%s", text.c_str(), terminal_ && !last ? "" : "\n");
  std::fflush(stdout);
}

}  // namespace rover::campaign
