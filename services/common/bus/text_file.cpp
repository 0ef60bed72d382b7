#include "common/bus/text_file.hpp"

#include <filesystem>
#include <fstream>

#include "common/bus/config.hpp"

namespace rover {

std::string read_text(const std::string& file, size_t max_bytes) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) throw ConfigError(file + ": no such file");
  if (!std::filesystem::is_regular_file(status)) throw ConfigError(file + ": not a file");
  const auto bytes = std::filesystem::file_size(file, error);
  if (error) throw ConfigError(file + ": " + error.message());
  if (bytes > max_bytes)
    throw ConfigError(file + ": " + std::to_string(bytes >> 20) + " MB; at most " + std::to_string(max_bytes >> 20) +
                      " MB are expected here");
  std::string text(bytes, '\0');
  std::ifstream in(file, std::ios::binary);
  if (!in.read(text.data(), static_cast<std::streamsize>(bytes))) throw ConfigError(file + ": cannot be read");
  if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
  return text;
}

}  // namespace rover
