// Images of a folder, sorted by the numbers in their names.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace rover::interchange {

// PNG and JPEG, by the last number of the name. Other files are counted in `skipped`. Throws ConfigError if a number
// is missing or repeated.
std::map<std::int64_t, std::filesystem::path> numbered_pictures(const std::filesystem::path& dir,
                                                                std::map<std::string, int>& skipped);

}  // namespace rover::interchange
