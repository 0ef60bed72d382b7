// One line: rows, drives, expected end.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace rover::campaign {

// "2 h 05 min", "3 min 20 s"
std::string duration_text(double seconds);

// `rows` of `jobs` are there; since the start `new_rows` came in elapsed_s.
std::string progress_text(std::int64_t rows, std::int64_t jobs, std::int64_t new_rows, double elapsed_s);

// On a terminal it rewrites the line; in a file it adds one a minute.
class ProgressLine {
 public:
  ProgressLine(std::int64_t rows, std::int64_t jobs);
  void show(std::int64_t rows);
  // Ends the line.
  void finish(std::int64_t rows);

 private:
  void print(std::int64_t rows, bool last);

  std::int64_t first_rows_;
  std::int64_t jobs_;
  bool terminal_;
  std::chrono::steady_clock::time_point start_;
  std::optional<std::chrono::steady_clock::time_point> printed_;
};

}  // namespace rover::campaign
