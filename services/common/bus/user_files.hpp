// Paths of the user, and output files and folders that never replace existing ones.
#pragma once

#include <filesystem>
#include <string>

namespace rover {

// The project's folder, which contains config/ and logs/: the parent of this program's build folder.
std::string project_dir();

// Absolute path without ".", ".." and trailing slash; a leading "~" is the home folder. The last component is not
// resolved if it is a symbolic link.
std::string user_path(const std::string& typed);

// Why the path is not an existing folder, or file; empty if it is.
std::string folder_problem(const std::string& path);
std::string file_problem(const std::string& path);

// Creates a folder completely or not at all.
class NewFolder {
 public:
  // `path` may be absent, an empty folder, or contain only the remains of an interrupted command. Otherwise throws
  // ConfigError with one line.
  explicit NewFolder(const std::string& path);
  // Removes the folder unless keep() was called.
  ~NewFolder();
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

  // Temporary folder to write to.
  const std::filesystem::path& dir() const { return dir_; }
  // Moves the content to its final place.
  void keep();

 private:
  std::filesystem::path target_;
  std::filesystem::path dir_;
  bool target_is_new_ = false;
  int lock_ = -1;
};

// Creates a file completely or not at all.
class NewFile {
 public:
  // Throws ConfigError with one line if the path exists, or its folder does not.
  explicit NewFile(const std::string& path);
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  // Temporary file to write to.
  const std::string& path() const { return unfinished_; }
  // Renames it to its final name. Throws ConfigError if the path exists by now.
  void keep();

 private:
  std::string target_;
  std::string unfinished_;
};

}  // namespace rover
