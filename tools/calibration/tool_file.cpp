#include "tools/calibration/tool_file.hpp"

#include <cmath>

#include "common/bus/config.hpp"
#include "common/bus/text_file.hpp"
#include "common/bus/yaml_file.hpp"
#include "common/core/decimal.hpp"
#include "tools/calibration/opencv_xml.hpp"

namespace rover::calibration {
namespace {

constexpr size_t kMaxTextBytes = 1 << 20;

void blank(std::string& text, const std::string& part) {
  for (size_t at = 0; (at = text.find(part, at)) != std::string::npos;) text.replace(at, part.size(), part.size(), ' ');
}

// Removes OpenCV's matrix tags, and the next document's start in `rostopic echo` output.
YAML::Node parse_foreign_yaml(std::string text, const std::string& name) {
  blank(text, "!!opencv-matrix");
  const size_t end = text.find_last_not_of(" \t\r\n");
  if (end != std::string::npos && end > 3 && text.compare(end - 3, 4, "\n---") == 0) text.resize(end - 2);
  return parse_yaml(text, name);
}

void append_numbers(const YAML::Node& node, std::vector<double>& values) {
  if (node.IsSequence()) {
    for (const YAML::Node& item : node) append_numbers(item, values);
    return;
  }
  const auto number = node.IsScalar() ? parse_number(node.Scalar()) : std::nullopt;
  if (!number) throw ConfigError(node.IsScalar() ? "'" + node.Scalar() + "' is not a number" : "not a list of numbers");
  values.push_back(*number);
}

}  // namespace

ToolFile::ToolFile(YAML::Node node, std::string file, std::string prefix)
    : node_(std::move(node)), file_(std::move(file)), prefix_(std::move(prefix)) {}

ToolFile ToolFile::load(const std::string& file) {
  const std::string text = read_text(file, kMaxTextBytes);
  const size_t begin = text.find_first_not_of(" \t\r\n");
  const bool xml = begin != std::string::npos && text[begin] == '<';
  ToolFile root(xml ? parse_opencv_xml(text, file) : parse_foreign_yaml(text, file), file, "");
  if (!root.node_.IsMap()) throw ConfigError(file + ": not a calibration: keys with values are expected");
  return root;
}

bool ToolFile::has(const std::string& key) const {
  return static_cast<bool>(node_[key]);
}

std::string ToolFile::name_of(const std::vector<std::string>& names) const {
  for (const std::string& name : names)
    if (has(name)) return name;
  return names.front();
}

void ToolFile::fail(const std::string& key, const std::string& what) const {
  const YAML::Mark mark = (has(key) ? node_[key] : node_).Mark();
  const std::string line = mark.is_null() ? "" : ":" + std::to_string(mark.line + 1);
  throw ConfigError(file_ + line + ": " + prefix_ + key + ": " + what);
}

YAML::Node ToolFile::required(const std::string& key) const {
  if (!has(key)) fail(key, "missing");
  return node_[key];
}

ToolFile ToolFile::section(const std::string& key) const {
  const YAML::Node node = required(key);
  if (!node.IsMap()) fail(key, "a section is expected; are the keys under it indented?");
  return {node, file_, prefix_ + key + "."};
}

std::string ToolFile::text(const std::string& key) const {
  const YAML::Node node = required(key);
  if (!node.IsScalar()) fail(key, "a single value is expected");
  return node.Scalar();
}

std::vector<double> ToolFile::numbers(const std::string& key) const {
  YAML::Node node = required(key);
  if (node.IsMap() && node["data"]) node.reset(node["data"]);
  std::vector<double> values;
  if (!node.IsSequence()) fail(key, "not a list of numbers");
  try {
    append_numbers(node, values);
  } catch (const ConfigError& error) {
    fail(key, error.what());
  }
  return values;
}

std::vector<double> ToolFile::numbers(const std::string& key, size_t count) const {
  const std::vector<double> values = numbers(key);
  if (values.size() != count) fail(key, std::to_string(values.size()) + " numbers instead of " + std::to_string(count));
  return values;
}

int ToolFile::size_px(const std::string& key) const {
  if (!has(key)) return 0;
  const auto number = parse_number(text(key));
  if (!number || *number < 1 || *number > 8192 || *number != std::floor(*number)) fail(key, "not an image size");
  return static_cast<int>(*number);
}

Eigen::Isometry3d ToolFile::pose(const std::string& key) const {
  const std::vector<double> m = numbers(key, 16);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 16; ++i) T.matrix()(i / 4, i % 4) = m[static_cast<size_t>(i)];
  if (!T.matrix().row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1), 1e-6)) fail(key, "the last row is not 0 0 0 1");
  if ((T.linear() * T.linear().transpose() - Eigen::Matrix3d::Identity()).norm() > 1e-3 ||
      T.linear().determinant() < 0.0)
    fail(key, "the upper left 3 x 3 is not a rotation");
  return T;
}

void ToolFile::set_lens(PinholeCamera& camera, const std::string& model, const std::string& key) const {
  const bool none = model == "none" && !has(key);
  const std::string problem = calibration::set_lens(camera, model, none ? std::vector<double>{} : numbers(key));
  if (!problem.empty()) fail(key, problem);
}

}  // namespace rover::calibration
