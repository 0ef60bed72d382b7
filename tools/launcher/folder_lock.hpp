// Keeps a second process out of a folder that one is writing to.
#pragma once

#include <string>

namespace rover {

class FolderLock {
 public:
  // Makes the folder. Throws ConfigError, with the line `in_use` if another process holds it.
  FolderLock(const std::string& dir, const std::string& in_use);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int file_ = -1;
};

}  // namespace rover
