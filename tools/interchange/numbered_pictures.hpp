// The pictures of a folder, by the numbers in their names.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace rover::interchange {

// PNG and JPEG, by the last number in each name: 2.png comes before 10.png. What is none is counted in `left_out`, by
// what it is. Throws ConfigError where a name has no number, or two have the same.
std::map<std::int64_t, std::filesystem::path> numbered_pictures(const std::filesystem::path& dir,
                                                                std::map<std::string, int>& left_out);

}  // namespace rover::interchange
