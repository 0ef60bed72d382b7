#include "common/core/check.hpp"

#include <cstdio>
#include <cstdlib>

namespace rover {

void check_failed(const char* condition, const char* file, int line, const std::string& values) {
  std::fprintf(stderr, "%s:%d: check failed: %s%s\n", file, line, condition, values.c_str());
  std::abort();
}

}  // namespace rover
