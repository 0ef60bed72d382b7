#include "common/bus/config.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "common/bus/yaml_file.hpp"
#include "common/core/decimal.hpp"
#include "common/core/frames.hpp"

namespace rover {

struct Config::Seen {
  std::set<std::string> keys;
  std::vector<Config> children;
};

namespace {

// Not in quotes.
bool is_plain(const YAML::Node& node) {
  return node.Tag() != "!";
}

std::string where(const std::string& file, const YAML::Node& node) {
  const YAML::Mark mark = node.Mark();
  return mark.is_null() ? file : file + ":" + std::to_string(mark.line + 1);
}

const YAML::Node& checked_map(const YAML::Node& node, const std::string& file) {
  if (!node.IsMap()) throw ConfigError(where(file, node) + ": a mapping of keys to values is expected here");
  return node;
}

// As it is written, short enough for a line.
std::string shown(const YAML::Node& node) {
  constexpr size_t kMax = 60;
  std::string text = node.Scalar();
  if (text.size() > kMax) text.replace(kMax, std::string::npos, "...");
  const std::string quote = is_plain(node) ? "'" : "\"";
  return quote + text + quote;
}

}  // namespace

Config::Config(YAML::Node node, std::string file, std::string prefix)
    : node_(std::move(node)), file_(std::move(file)), prefix_(std::move(prefix)), seen_(std::make_shared<Seen>()) {}

std::string one_line(std::string text) {
  constexpr size_t kBegin = 1000, kEnd = 300;  // what is wrong, and what to do
  if (text.size() > 2 * kBegin) text.replace(kBegin, text.size() - kBegin - kEnd, " ... ");
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, ' ');
  return text;
}

ConfigError::ConfigError(const std::string& what) : std::runtime_error(one_line(what)) {}

Config Config::load(const std::string& file) {
  return {checked_map(load_yaml(file), file), file, ""};
}

Config Config::parse(const std::string& text, const std::string& name) {
  return {checked_map(parse_yaml(text, name), name), name, ""};
}

bool Config::has(const std::string& key) const {
  return static_cast<bool>(node_[key]);
}

std::vector<std::string> Config::keys() const {
  std::vector<std::string> names;
  for (const auto& entry : node_) names.push_back(entry.first.as<std::string>());
  return names;
}

void Config::fail(const std::string& key, const std::string& what) const {
  const YAML::Node at = node_[key] ? node_[key] : node_;
  throw ConfigError(where(file_, at) + ": " + prefix_ + key + ": " + what);
}

YAML::Node Config::required(const std::string& key) const {
  seen_->keys.insert(key);
  const YAML::Node node = node_[key];
  if (!node) fail(key, "missing");
  return node;
}

YAML::Node Config::scalar(const std::string& key) const {
  const YAML::Node node = required(key);
  if (!node.IsScalar()) fail(key, "a single value is expected, not a list or a section");
  return node;
}

namespace {

std::string range_text(Range range) {
  std::ostringstream text;
  text << "out of range [" << range.min << ", " << range.max << "]";
  return text.str();
}

bool outside(double value, Range range) {
  return !std::isfinite(value) || value < range.min || value > range.max;
}

}  // namespace

double Config::number_in(const YAML::Node& node, const std::string& key, Range range) const {
  const auto number = is_plain(node) ? parse_number(node.Scalar()) : std::nullopt;
  if (!number) fail(key, "not a number: " + shown(node) + "; plain decimal is expected, as 0.5 or 1e-3");
  if (outside(*number, range)) fail(key, range_text(range));
  return *number;
}

double Config::number(const std::string& key, Range range) const {
  return number_in(scalar(key), key, range);
}

std::int64_t Config::integer64(const std::string& key, Range range) const {
  const YAML::Node node = scalar(key);
  const auto number = is_plain(node) ? parse_whole_number(node.Scalar()) : std::nullopt;
  if (!number) fail(key, "not a whole number: " + shown(node) + "; decimal digits are expected, no leading zero");
  if (outside(static_cast<double>(*number), range)) fail(key, range_text(range));
  return *number;
}

int Config::integer(const std::string& key, Range range) const {
  return static_cast<int>(integer64(key, {std::max(range.min, -2147483648.0), std::min(range.max, 2147483647.0)}));
}

bool Config::boolean(const std::string& key) const {
  const YAML::Node node = scalar(key);
  if (!is_plain(node) || (node.Scalar() != "true" && node.Scalar() != "false"))
    fail(key, shown(node) + " is neither true nor false");
  return node.Scalar() == "true";
}

std::string Config::text(const std::string& key) const {
  return scalar(key).Scalar();
}

std::string Config::one_of(const std::string& key, const std::vector<std::string>& choices) const {
  const std::string choice = text(key);
  std::string list;
  for (const std::string& allowed : choices) {
    if (choice == allowed) return choice;
    list += (list.empty() ? "" : ", ") + allowed;
  }
  fail(key, shown(required(key)) + " is not one of " + list);
}

std::vector<double> Config::numbers(const std::string& key, Range range, size_t count) const {
  const YAML::Node node = required(key);
  if (!node.IsSequence()) fail(key, "not a list of numbers");
  if (count != 0 && node.size() != count)
    fail(key, std::to_string(count) + " numbers expected, found " + std::to_string(node.size()));
  std::vector<double> values;
  for (const YAML::Node& item : node) {
    if (!item.IsScalar()) fail(key, "not a list of numbers");
    values.push_back(number_in(item, key, range));
  }
  return values;
}

Config Config::section(const std::string& key) const {
  const YAML::Node node = required(key);
  Config child(checked_map(node, file_), file_, prefix_ + key + ".");
  seen_->children.push_back(child);
  return child;
}

std::vector<Config> Config::list(const std::string& key) const {
  const YAML::Node node = required(key);
  if (!node.IsSequence()) fail(key, "not a list");
  std::vector<Config> items;
  for (const YAML::Node& item : node) {
    items.push_back(Config(checked_map(item, file_), file_, prefix_ + key + "[" + std::to_string(items.size()) + "]."));
    seen_->children.push_back(items.back());
  }
  return items;
}

void Config::read(const std::string& key, double& value, Range range) const {
  if (has(key)) value = number(key, range);
}

void Config::read(const std::string& key, int& value, Range range) const {
  if (has(key)) value = integer(key, range);
}

void Config::read(const std::string& key, bool& value) const {
  if (has(key)) value = boolean(key);
}

void Config::read(const std::string& key, std::string& value) const {
  if (has(key)) value = text(key);
}

void Config::read_deg(const std::string& key, double& value_rad, Range range_deg) const {
  if (has(key)) value_rad = to_rad(number(key, range_deg));
}

void Config::finish() const {
  for (const auto& entry : node_) {
    const auto key = entry.first.as<std::string>();
    if (!seen_->keys.contains(key))
      throw ConfigError(where(file_, entry.first) + ": " + prefix_ + key + ": unknown key");
  }
  for (const Config& child : seen_->children) child.finish();
}

}  // namespace rover
