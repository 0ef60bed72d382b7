// The folder in which a parser finds its files: what is written there is the user's, and has to stay as it is.
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace rover::fuzz {

class Scratch {
 public:
  explicit Scratch(const std::filesystem::path& dir);
  // The file's path. Folders are made.
  std::string write(const std::string& name, const std::string& bytes);
  // Of a new folder or file for results.
  std::string out() const { return (dir_ / "out").string(); }
  std::string dir() const { return dir_.string(); }
  // The name of a file of the user's that is no longer what was written; empty: none.
  std::string changed() const;
  void remove_results();

 private:
  std::filesystem::path dir_;
  std::map<std::string, std::string> files_;
};

}  // namespace rover::fuzz
