#include "tools/interchange/numbered_pictures.hpp"

#include <algorithm>
#include <charconv>

#include "common/bus/config.hpp"

namespace rover::interchange {
namespace {

namespace fs = std::filesystem;

bool is_picture(const fs::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending == ".png" || ending == ".jpg" || ending == ".jpeg";
}

std::int64_t number_of(const fs::path& file) {
  const std::string name = file.stem().string();
  const size_t last = name.find_last_of("0123456789");
  if (last == std::string::npos)
    throw ConfigError(file.string() + ": no number in the name; images are sorted by their numbers");
  const size_t before = name.find_last_not_of("0123456789", last);
  const size_t first = before == std::string::npos ? 0 : before + 1;
  std::int64_t number = 0;
  if (std::from_chars(name.data() + first, name.data() + last + 1, number).ec != std::errc())
    throw ConfigError(file.string() + ": the number in the name is too large");
  return number;
}

}  // namespace

std::map<std::int64_t, fs::path> numbered_pictures(const fs::path& dir, std::map<std::string, int>& skipped) {
  std::map<std::int64_t, fs::path> pictures;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(dir, error)) {
    const fs::path& file = entry.path();
    if (file.filename().string().starts_with(".")) {
      ++skipped["hidden files"];
    } else if (!is_picture(file)) {
      ++skipped["files that are neither PNG nor JPEG"];
    } else if (const auto [there, is_new] = pictures.emplace(number_of(file), file); !is_new) {
      throw ConfigError(file.string() + ": has the number of " + there->second.filename().string() +
                        "; which one is the picture?");
    }
  }
  if (error) throw ConfigError(dir.string() + ": " + error.message());
  if (pictures.empty()) throw ConfigError(dir.string() + ": no pictures (PNG or JPEG)");
  return pictures;
}

}  // namespace rover::interchange
