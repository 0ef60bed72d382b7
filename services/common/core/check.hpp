// Assertions against programming errors, always on. They abort the process; s6 restarts it.
#pragma once

#include <sstream>
#include <string>

namespace rover {

[[noreturn]] void check_failed(const char* condition, const char* file, int line, const std::string& values);

template <class... Values>
std::string values_text(const Values&... values) {
  std::ostringstream text;
  ((text << ' ' << values), ...);
  return text.str();
}

}  // namespace rover

// ROVER_CHECK(condition, values...): prints the values and aborts if the condition is false.
#define ROVER_CHECK(condition, ...)                                                             \
  do {                                                                                          \
    if (!(condition)) [[unlikely]]                                                              \
      ::rover::check_failed(#condition, __FILE__, __LINE__, ::rover::values_text(__VA_ARGS__)); \
  } while (false)
