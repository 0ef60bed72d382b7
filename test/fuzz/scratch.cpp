#include "scratch.hpp"

#include <fstream>
#include <iterator>

namespace rover::fuzz {
namespace fs = std::filesystem;

Scratch::Scratch(const fs::path& dir) : dir_(dir) {
  fs::create_directories(dir_);
}

std::string Scratch::write(const std::string& name, const std::string& bytes) {
  const fs::path file = dir_ / name;
  const auto [known, is_new] = files_.try_emplace(name);
  if (!is_new && known->second == bytes) return file.string();
  known->second = bytes;
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << bytes;
  return file.string();
}

std::string Scratch::changed() const {
  for (const auto& [name, bytes] : files_) {
    std::ifstream file(dir_ / name, std::ios::binary);
    if (!file || std::string(std::istreambuf_iterator<char>(file), {}) != bytes) return name;
  }
  return "";
}

void Scratch::remove_results() {
  fs::remove_all(out());
}

}  // namespace rover::fuzz
