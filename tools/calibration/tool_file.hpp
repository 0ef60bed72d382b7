// A calibration file as a tree: YAML with any header, JSON or OpenCV XML, detected by its content.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>
#include <vector>

#include "tools/calibration/lens_model.hpp"

namespace rover::calibration {

// One section of the file. All functions throw ConfigError "FILE:LINE: KEY: reason".
class ToolFile {
 public:
  static ToolFile load(const std::string& file);

  bool has(const std::string& key) const;
  // The first of these names that exists, else the first.
  std::string name_of(const std::vector<std::string>& names) const;
  ToolFile section(const std::string& key) const;
  std::string text(const std::string& key) const;
  // A list, a list of rows, or a matrix section with `data` (OpenCV, ROS).
  std::vector<double> numbers(const std::string& key) const;
  std::vector<double> numbers(const std::string& key, size_t count) const;
  // 0 if missing; at most 8192.
  int size_px(const std::string& key) const;
  Eigen::Isometry3d pose(const std::string& key) const;
  // Reads `model` and the coefficients under `key`.
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
