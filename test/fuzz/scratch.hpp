// Folder with the input files of a parser, which it must not change.
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace rover::fuzz {

class Scratch {
 public:
  explicit Scratch(const std::filesystem::path& dir);
  // Path of the file; creates its folders.
  std::string write(const std::string& name, const std::string& bytes);
  // Path of a new folder or file for results.
  std::string out() const { return (dir_ / "out").string(); }
  std::string dir() const { return dir_.string(); }
  // Name of a changed input file; empty: none.
  std::string changed() const;
  void remove_results();

 private:
  std::filesystem::path dir_;
  std::map<std::string, std::string> files_;
};

}  // namespace rover::fuzz
