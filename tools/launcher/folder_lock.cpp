#include "tools/launcher/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "common/bus/config.hpp"

namespace rover {

FolderLock::FolderLock(const std::string& dir, const std::string& in_use) {
  std::error_code error;
  std::filesystem::create_directories(dir, error);
  if (error) throw ConfigError(dir + ": cannot be created: " + error.message());
  file_ = open((dir + "/lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file_ < 0) throw ConfigError(dir + ": cannot be written: " + std::strerror(errno));
  if (flock(file_, LOCK_EX | LOCK_NB) == 0) return;
  close(file_);
  throw ConfigError(dir + ": " + in_use);
}

FolderLock::~FolderLock() {
  close(file_);
}

}  // namespace rover
