// Reads whole text files of the user.
#pragma once

#include <string>

namespace rover {

// Without a byte order mark. Throws ConfigError if it is not a regular file, cannot be read or has more than
// `max_bytes`.
std::string read_text(const std::string& file, size_t max_bytes);

}  // namespace rover
