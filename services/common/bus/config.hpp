// Strict YAML (yaml_file.hpp): what is read must be there in the right type and range, and what is there must have been
// read. Every error is one line "file:line: key: what is wrong" in a ConfigError; main prints it and exits with 2.
// Numbers are plain decimal (core/decimal.hpp), truth values are true and false; in quotes each of them is a text.
#pragma once

#include <yaml-cpp/yaml.h>

#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace rover {

// Without control characters, and truncated in the middle beyond 2000 bytes.
std::string one_line(std::string text);

// One line of printable text, whatever of the user's it quotes.
class ConfigError : public std::runtime_error {
 public:
  explicit ConfigError(const std::string& what);
};

struct Range {
  double min;
  double max;
};

// One mapping of a YAML file. Copies share the record of what was read.
class Config {
 public:
  static Config load(const std::string& file);
  static Config parse(const std::string& text, const std::string& name);

  bool has(const std::string& key) const;
  std::vector<std::string> keys() const;

  // Required values. Numbers must be finite and in range.
  double number(const std::string& key, Range range) const;
  int integer(const std::string& key, Range range) const;
  std::int64_t integer64(const std::string& key, Range range) const;
  bool boolean(const std::string& key) const;
  std::string text(const std::string& key) const;
  std::string one_of(const std::string& key, const std::vector<std::string>& choices) const;
  std::vector<double> numbers(const std::string& key, Range range, size_t count) const;  // count 0: any number
  Config section(const std::string& key) const;
  std::vector<Config> list(const std::string& key) const;

  // Optional values: leave `value` as it is where the key is absent.
  void read(const std::string& key, double& value, Range range) const;
  void read(const std::string& key, int& value, Range range) const;
  void read(const std::string& key, bool& value) const;
  void read(const std::string& key, std::string& value) const;
  // The key ends in _deg, the value is stored in radians; the range is in degrees.
  void read_deg(const std::string& key, double& value_rad, Range range_deg) const;

  // Throws on the first key, here or in a section taken from here, that nobody has read.
  void finish() const;
  // For a check that spans several keys.
  [[noreturn]] void fail(const std::string& key, const std::string& what) const;
  const std::string& file() const { return file_; }

 private:
  Config(YAML::Node node, std::string file, std::string prefix);
  YAML::Node required(const std::string& key) const;
  YAML::Node scalar(const std::string& key) const;
  double number_in(const YAML::Node& node, const std::string& key, Range range) const;

  struct Seen;
  YAML::Node node_;
  std::string file_;
  std::string prefix_;
  std::shared_ptr<Seen> seen_;
};

}  // namespace rover
