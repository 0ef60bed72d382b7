#include "common/bus/checkpoint.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace rover {
namespace {

constexpr std::uint64_t kMagic = 0x31545043'52564f52;  // marks the file's format

struct FileHead {
  std::uint64_t magic;
  std::uint64_t size;
  std::uint64_t checksum;
};

// FNV-1a on words: detects truncated and overwritten files.
std::uint64_t checksum(const std::vector<std::uint8_t>& bytes) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (size_t i = 0; i < bytes.size(); i += sizeof hash) {
    std::uint64_t word = 0;
    std::memcpy(&word, &bytes[i], std::min(sizeof word, bytes.size() - i));
    hash = (hash ^ word) * 0x100000001b3u;
  }
  return hash;
}

std::string path_of(const std::string& run_dir, const std::string& name) {
  return run_dir + "/" + name + ".ckpt";
}

}  // namespace

bool save_checkpoint(const std::string& run_dir, const std::string& name, const std::vector<std::uint8_t>& bytes) {
  const std::string path = path_of(run_dir, name);
  const std::string fresh = path + ".new";
  {
    std::ofstream file(fresh, std::ios::binary | std::ios::trunc);
    const FileHead head{kMagic, bytes.size(), checksum(bytes)};
    file.write(reinterpret_cast<const char*>(&head), sizeof head);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    file.flush();
    if (!file) return false;
  }
  return std::rename(fresh.c_str(), path.c_str()) == 0;
}

bool checkpoint_exists(const std::string& run_dir, const std::string& name) {
  std::error_code error;
  return std::filesystem::exists(path_of(run_dir, name), error);
}

std::optional<std::vector<std::uint8_t>> load_checkpoint(const std::string& run_dir, const std::string& name) {
  std::ifstream file(path_of(run_dir, name), std::ios::binary);
  FileHead head{};
  if (!file.read(reinterpret_cast<char*>(&head), sizeof head) || head.magic != kMagic) return std::nullopt;
  constexpr std::uint64_t kMaxBytes = 64u << 20;
  if (head.size > kMaxBytes) return std::nullopt;
  std::vector<std::uint8_t> bytes(head.size);
  if (!file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size())))
    return std::nullopt;
  if (checksum(bytes) != head.checksum) return std::nullopt;
  return bytes;
}

}  // namespace rover
