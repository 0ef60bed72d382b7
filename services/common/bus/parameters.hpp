// The parameters of one service. Its config.cpp describes each of them once: key, value, range, meaning. The
// description reads them from the service's YAML file, checks them, and makes the file, the table and `./rover config`.
// The unit is the end of the key (_m, _deg, _mps); the default is what the value held before.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/bus/config.hpp"
#include "common/core/time.hpp"

namespace rover {

struct Parameter {
  std::string key;            // with its sections: map.cell_m
  std::string default_value;  // as in YAML
  std::string range;          // empty: any
  std::string meaning;
  bool section = false;  // a heading without a value
};

struct ParameterList {
  std::string title;
  std::vector<Parameter> parameters;
};

class Parameters {
 public:
  // With a list, the description goes there and no file is read. Throws ConfigError, as all that reads from the file.
  Parameters(const std::string& file, const std::string& title, ParameterList* list = nullptr);

  // Keys that the file does not have leave `value` as it is. Numbers must be finite and in range.
  void add(const std::string& key, double& value, Range range, const std::string& meaning);
  void add(const std::string& key, int& value, Range range, const std::string& meaning);
  void add(const std::string& key, std::uint64_t& value, Range range, const std::string& meaning);
  void add(const std::string& key, bool& value, const std::string& meaning);
  void add(const std::string& key, std::string& value, const std::string& meaning);
  void add_choice(const std::string& key, std::string& value, const std::vector<std::string>& choices,
                  const std::string& meaning);
  // In degrees in the file, in radians in `value`.
  void add_deg(const std::string& key, double& value_rad, Range range_deg, const std::string& meaning);
  // In seconds in the file, in microseconds in `value`.
  void add_s(const std::string& key, Utime& value_us, Range range_s, const std::string& meaning);

  // Parameters under a key of their own; a file without the section leaves all of them.
  Parameters section(const std::string& key, const std::string& meaning);

  // A check across several keys; `key` is the one to blame.
  void check(bool met, const std::string& key, const std::string& what) const;
  // Throws on the first key of the file that nobody has described.
  void finish() const;

 private:
  Parameters(std::optional<Config> yaml, std::string prefix, ParameterList* list, std::string file);
  bool given(const std::string& key) const { return yaml_ && yaml_->has(key); }
  void note(const std::string& key, const std::string& default_value, const std::string& range,
            const std::string& meaning);

  std::optional<Config> yaml_;
  std::string prefix_;
  ParameterList* list_;
  std::string file_;
};

// "m/s" of max_speed_mps; empty: a count, a ratio or a text.
std::string unit_of(const std::string& key);

// The YAML file of the defaults.
std::string to_yaml(const ParameterList& list);
// A table for a README: parameter, default, unit, range, meaning.
std::string to_markdown(const ParameterList& list);
// A table for a terminal.
std::string to_text(const ParameterList& list);
// One of the three: "yaml", "markdown", "text".
std::string to_format(const ParameterList& list, const std::string& format);

}  // namespace rover
