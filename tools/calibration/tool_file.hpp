// A calibration file of another tool: YAML under any head, JSON, or OpenCV's XML, told apart by its content.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>
#include <vector>

#include "tools/calibration/lens_model.hpp"

namespace rover::calibration {

// One section of it. All throw ConfigError "FILE:LINE: KEY: what is wrong".
class ToolFile {
 public:
  static ToolFile load(const std::string& file);

  bool has(const std::string& key) const;
  // The first of these names that is there, else the first.
  std::string name_of(const std::vector<std::string>& names) const;
  ToolFile section(const std::string& key) const;
  std::string text(const std::string& key) const;
  // A list, a list of rows, or a matrix as OpenCV and ROS write it: a section with `data`.
  std::vector<double> numbers(const std::string& key) const;
  std::vector<double> numbers(const std::string& key, size_t count) const;
  // 0 where there is none; at most 8192.
  int size_px(const std::string& key) const;
  Eigen::Isometry3d pose(const std::string& key) const;
  // `model` and the coefficients under `key`.
  void set_lens(PinholeCamera& camera, const std::string& model, const std::string& key) const;
  [[noreturn]] void fail(const std::string& key, const std::string& what) const;
  const std::string& file() const { return file_; }

 private:
  ToolFile(YAML::Node node, std::string file, std::string prefix);
  YAML::Node required(const std::string& key) const;

  YAML::Node node_;
  std::string file_;
  std::string prefix_;
};

}  // namespace rover::calibration
