#include "common/bus/user_files.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include "common/bus/config.hpp"

namespace rover {
namespace fs = std::filesystem;
namespace {

constexpr const char* kUnfinished = ".unfinished";

std::string reason_of(int error) {
  return std::generic_category().message(error);
}

// True for the remains of an interrupted or running command.
bool holds_only_unfinished(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().filename() != kUnfinished) return false;
  return true;
}

}  // namespace

std::string project_dir() {
  return fs::canonical("/proc/self/exe").parent_path().parent_path().parent_path().string();
}

std::string user_path(const std::string& typed) {
  if (typed.empty()) throw ConfigError("an empty path");
  fs::path path = typed;
  const char* home = std::getenv("HOME");
  if (home != nullptr && (typed == "~" || typed.rfind("~/", 0) == 0)) path = home + typed.substr(1);
  std::error_code error;
  path = fs::absolute(path, error);
  if (!path.has_filename()) path = path.parent_path();
  const bool has_name = path.has_filename() && path.filename() != "." && path.filename() != "..";
  const fs::path folder = error ? path : fs::weakly_canonical(has_name ? path.parent_path() : path, error);
  if (error) throw ConfigError(typed + ": " + error.message());
  return (has_name ? folder / path.filename() : folder).string();
}

std::string folder_problem(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) return "";
  return fs::exists(status) ? "is a file; a folder is expected" : "no such folder";
}

std::string file_problem(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_regular_file(status)) return "";
  return fs::is_directory(status) ? "is a folder; a file is expected" : "no such file";
}

NewFolder::NewFolder(const std::string& path) : target_(fs::absolute(path)) {
  std::error_code error;
  target_is_new_ = fs::create_directories(target_, error);
  if (error) throw ConfigError(target_.string() + ": cannot be created: " + error.message());
  try {
    if (!holds_only_unfinished(target_))
      throw ConfigError(target_.string() + ": already exists and is not empty; choose another folder");
    dir_ = target_ / kUnfinished;
    fs::create_directory(dir_);
    lock_ = open(dir_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NOFOLLOW);
    if (lock_ < 0 || flock(lock_, LOCK_EX | LOCK_NB) != 0)
      throw ConfigError(target_.string() + ": another command is writing to it");
    for (const auto& left : fs::directory_iterator(dir_)) fs::remove_all(left.path());
  } catch (const fs::filesystem_error& failure) {
    if (lock_ >= 0) close(lock_);
    if (target_is_new_) fs::remove(target_, error);
    throw ConfigError(target_.string() + ": cannot be written: " + failure.code().message());
  } catch (const ConfigError&) {
    if (lock_ >= 0) close(lock_);
    throw;
  }
}

NewFolder::~NewFolder() {
  std::error_code ignored;
  if (!dir_.empty()) {
    fs::remove_all(dir_, ignored);
    if (target_is_new_) fs::remove(target_, ignored);
  }
  close(lock_);
}

void NewFolder::keep() {
  try {
    for (const auto& entry : fs::directory_iterator(dir_)) {
      const fs::path to = target_ / entry.path().filename();
      if (fs::exists(fs::symlink_status(to))) throw ConfigError(to.string() + ": was created meanwhile; not replaced");
      fs::rename(entry.path(), to);
    }
    fs::remove(dir_);
    dir_.clear();
  } catch (const fs::filesystem_error& failure) {
    throw ConfigError(target_.string() + ": cannot be written: " + failure.code().message());
  }
}

NewFile::NewFile(const std::string& path) : target_(fs::absolute(path).string()) {
  const fs::path target(target_);
  if (fs::exists(fs::symlink_status(target)))
    throw ConfigError(target_ + ": already exists and is not replaced; choose another file");
  if (!fs::is_directory(target.parent_path())) throw ConfigError(target.parent_path().string() + ": no such folder");
  std::string name = (target.parent_path() / ("." + target.filename().string() + ".XXXXXX")).string();
  const int file = mkstemp(name.data());
  if (file < 0) throw ConfigError(target_ + ": cannot be written: " + reason_of(errno));
  const mode_t mask = umask(0);  // mkstemp creates files with mode 0600
  umask(mask);
  fchmod(file, 0666 & ~mask);
  close(file);
  unfinished_ = name;
}

NewFile::~NewFile() {
  if (!unfinished_.empty()) unlink(unfinished_.c_str());
}

void NewFile::keep() {
  // Atomic, and never replaces a file.
  if (renameat2(AT_FDCWD, unfinished_.c_str(), AT_FDCWD, target_.c_str(), RENAME_NOREPLACE) != 0)
    throw ConfigError(target_ + ": cannot be written: " + reason_of(errno));
  unfinished_.clear();
}

}  // namespace rover
