// Text files of the user's, read whole.
#pragma once

#include <string>

namespace rover {

// Without the mark of UTF-8 at its beginning. Throws ConfigError where it is no file (a folder, a pipe), cannot be read
// or has more than `most_bytes`.
std::string read_text(const std::string& file, size_t most_bytes);

}  // namespace rover
