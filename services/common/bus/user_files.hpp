// Paths as users type them, and what a command makes: never in place of anything that was there before.
#pragma once

#include <filesystem>
#include <string>

namespace rover {

// The project's folder, which holds config/ and logs/: that of the build folder in which this program lies.
std::string project_dir();

// Absolute, from the folder that the user is in; a leading "~" is the home folder; no "." or "..", no slash at the end.
// The last name stays as it was typed, also where it is a symbolic link.
std::string user_path(const std::string& typed);

// A folder that a command makes, whole or not at all.
class NewFolder {
 public:
  // Where `path` is nothing yet, or an empty folder, or holds only what an interrupted command has left. Throws
  // ConfigError with one line elsewhere.
  explicit NewFolder(const std::string& path);
  // Removes what was not kept.
  ~NewFolder();
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

  // Where to write until then.
  const std::filesystem::path& dir() const { return dir_; }
  // Moves what was written to its place.
  void keep();

 private:
  std::filesystem::path target_;
  std::filesystem::path dir_;
  bool target_is_new_ = false;
  int lock_ = -1;
};

// A file that a command makes, whole or not at all.
class NewFile {
 public:
  // Throws ConfigError with one line where there is something already, or no folder for it.
  explicit NewFile(const std::string& path);
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  // Where to write until then.
  const std::string& path() const { return unfinished_; }
  // Gives it its name; throws ConfigError where something has come there meanwhile.
  void keep();

 private:
  std::string target_;
  std::string unfinished_;
};

}  // namespace rover
