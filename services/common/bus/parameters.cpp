#include "common/bus/parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "common/core/frames.hpp"

namespace rover {
namespace {

// Nine digits: 0.6 deg, kept in radians, is 0.6 again.
std::string text_of(double number) {
  std::string text = fmt::format("{:.9g}", number);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string range_of(Range range) {
  return fmt::format("{:g} to {:g}", range.min, range.max);
}

}  // namespace

Parameters::Parameters(const std::string& file, const std::string& title, ParameterList* list)
    : Parameters(list == nullptr ? std::optional(Config::load(file)) : std::nullopt, "", list, file) {
  if (list_ != nullptr) list_->title = title;
}

Parameters::Parameters(std::optional<Config> yaml, std::string prefix, ParameterList* list, std::string file)
    : yaml_(std::move(yaml)), prefix_(std::move(prefix)), list_(list), file_(std::move(file)) {}

void Parameters::note(const std::string& key, const std::string& default_value, const std::string& range,
                      const std::string& meaning) {
  if (list_ != nullptr) list_->parameters.push_back({prefix_ + key, default_value, range, meaning});
}

void Parameters::add(const std::string& key, double& value, Range range, const std::string& meaning) {
  note(key, text_of(value), range_of(range), meaning);
  if (given(key)) value = yaml_->number(key, range);
}

void Parameters::add(const std::string& key, int& value, Range range, const std::string& meaning) {
  note(key, std::to_string(value), range_of(range), meaning);
  if (given(key)) value = yaml_->integer(key, range);
}

void Parameters::add(const std::string& key, std::uint64_t& value, Range range, const std::string& meaning) {
  note(key, std::to_string(value), range_of(range), meaning);
  if (given(key)) value = static_cast<std::uint64_t>(yaml_->integer64(key, range));
}

void Parameters::add(const std::string& key, bool& value, const std::string& meaning) {
  note(key, value ? "true" : "false", "true, false", meaning);
  if (given(key)) value = yaml_->boolean(key);
}

void Parameters::add(const std::string& key, std::string& value, const std::string& meaning) {
  note(key, value.empty() ? "\"\"" : value, "", meaning);
  if (given(key)) value = yaml_->text(key);
}

void Parameters::add_choice(const std::string& key, std::string& value, const std::vector<std::string>& choices,
                            const std::string& meaning) {
  note(key, value, fmt::format("{}", fmt::join(choices, ", ")), meaning);
  if (given(key)) value = yaml_->one_of(key, choices);
}

void Parameters::add_deg(const std::string& key, double& value_rad, Range range_deg, const std::string& meaning) {
  note(key, text_of(to_deg(value_rad)), range_of(range_deg), meaning);
  if (given(key)) value_rad = to_rad(yaml_->number(key, range_deg));
}

void Parameters::add_s(const std::string& key, Utime& value_us, Range range_s, const std::string& meaning) {
  note(key, text_of(to_seconds(value_us)), range_of(range_s), meaning);
  if (given(key)) value_us = to_utime(yaml_->number(key, range_s));
}

Parameters Parameters::section(const std::string& key, const std::string& meaning) {
  if (list_ != nullptr) list_->parameters.push_back({prefix_ + key, "", "", meaning, true});
  std::optional<Config> yaml;
  if (given(key)) yaml = yaml_->section(key);
  return {yaml, prefix_ + key + ".", list_, file_};
}

void Parameters::check(bool met, const std::string& key, const std::string& what) const {
  if (met) return;
  if (yaml_) yaml_->fail(key, what);
  throw ConfigError(file_ + ": " + prefix_ + key + ": " + what);
}

void Parameters::finish() const {
  if (yaml_) yaml_->finish();
}

std::string unit_of(const std::string& key) {
  // The longest ends first.
  static constexpr std::array kUnits = {std::pair{"_radps_rts", "rad/s/√s"},
                                        std::pair{"_mps2_rthz", "m/s²/√Hz"},
                                        std::pair{"_deg_per_sqrt_m", "deg/√m"},
                                        std::pair{"_deg_per_sqrt_s", "deg/√s"},
                                        std::pair{"_px_per_px", "px/px"},
                                        std::pair{"_m2_per_m", "m²/m"},
                                        std::pair{"_m_per_rad", "m/rad"},
                                        std::pair{"_deg_per_m", "deg/m"},
                                        std::pair{"_m_per_m", "m/m"},
                                        std::pair{"_rad_rts", "rad/√s"},
                                        std::pair{"_m_rtm", "m/√m"},
                                        std::pair{"_degps2", "deg/s²"},
                                        std::pair{"_per_m3", "1/m³"},
                                        std::pair{"_degps", "deg/s"},
                                        std::pair{"_radps", "rad/s"},
                                        std::pair{"_per_m", "1/m"},
                                        std::pair{"_mps2", "m/s²"},
                                        std::pair{"_px16", "px/16"},
                                        std::pair{"_cells", "cells"},
                                        std::pair{"_percent", "%"},
                                        std::pair{"_mps", "m/s"},
                                        std::pair{"_deg", "deg"},
                                        std::pair{"_m2", "m²"},
                                        std::pair{"_px", "px"},
                                        std::pair{"_gb", "GB"},
                                        std::pair{"_kg", "kg"},
                                        std::pair{"_m", "m"},
                                        std::pair{"_s", "s"},
                                        std::pair{"_a", "A"}};
  for (const auto& [end, unit] : kUnits)
    if (key.ends_with(end)) return unit;
  return {};
}

namespace {

std::string last_part(const std::string& key) {
  return key.substr(key.rfind('.') + 1);  // npos + 1 is 0
}

size_t depth_of(const Parameter& parameter) {
  return static_cast<size_t>(std::ranges::count(parameter.key, '.'));
}

// Words of `text` in lines of at most `width` characters.
std::vector<std::string> wrapped(const std::string& text, size_t width) {
  std::vector<std::string> lines = {""};
  for (size_t from = 0; from < text.size();) {
    const size_t to = std::min(text.find(' ', from), text.size());
    const std::string word = text.substr(from, to - from);
    if (!lines.back().empty() && lines.back().size() + 1 + word.size() > width) lines.emplace_back();
    lines.back() += (lines.back().empty() ? "" : " ") + word;
    from = to + 1;
  }
  return lines;
}

// Characters on a screen: bytes that do not continue one of UTF-8.
size_t width_of(const std::string& text) {
  return static_cast<size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string padded(const std::string& text, size_t width) {
  return text + std::string(width - std::min(width, width_of(text)), ' ');
}

}  // namespace

std::string to_yaml(const ParameterList& list) {
  constexpr size_t kWidth = 120;
  std::string out;
  for (const std::string& line : wrapped(list.title, kWidth - 2)) out += "# " + line + "\n";
  const auto code = [](const Parameter& p) {
    return std::string(2 * depth_of(p), ' ') + last_part(p.key) + ":" + (p.section ? "" : " " + p.default_value);
  };
  size_t column = 0;
  for (const Parameter& p : list.parameters) column = std::max(column, std::min<size_t>(width_of(code(p)) + 2, 48));
  for (const Parameter& p : list.parameters) {
    std::string line = code(p);
    if (p.meaning.empty()) {
      out += line + "\n";
      continue;
    }
    for (const std::string& part : wrapped(p.meaning, kWidth - column - 2)) {
      out += padded(line, std::max(column, width_of(line) + 2)) + "# " + part + "\n";
      line.clear();
    }
  }
  return out;
}

std::string to_markdown(const ParameterList& list) {
  std::string out = "| Parameter | Default | Unit | Range | Meaning |\n|---|---|---|---|---|\n";
  for (const Parameter& p : list.parameters) {
    if (p.section && p.meaning.empty()) continue;
    out += fmt::format("| `{}` | {} | {} | {} | {} |\n", p.key, p.default_value, p.section ? "" : unit_of(p.key),
                       p.range, p.meaning);
  }
  return out;
}

std::string to_text(const ParameterList& list) {
  size_t key = 0, value = 0, unit = 0, range = 0;
  for (const Parameter& p : list.parameters) {
    key = std::max(key, width_of(p.key));
    value = std::max(value, width_of(p.default_value));
    unit = std::max(unit, width_of(unit_of(p.key)));
    range = std::max(range, width_of(p.range));
  }
  std::string out = list.title + "\n";
  for (const Parameter& p : list.parameters) {
    const std::string of_unit = p.section ? "" : unit_of(p.key);
    std::string line = padded(p.key, key) + "  " + padded(p.default_value, value) + "  " + padded(of_unit, unit) +
                       "  " + padded(p.range, range) + "  " + p.meaning;
    line.erase(line.find_last_not_of(' ') + 1);
    out += line + "\n";
  }
  return out;
}

std::string to_format(const ParameterList& list, const std::string& format) {
  return format == "yaml" ? to_yaml(list) : format == "markdown" ? to_markdown(list) : to_text(list);
}

}  // namespace rover
