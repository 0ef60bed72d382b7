// Runs a parser on inputs in child processes. Each crash, timeout and excessive resource use is a finding.
#pragma once

#include <functional>
#include <limits>

#include "mutate.hpp"
#include "scratch.hpp"

namespace rover::fuzz {

struct Parser {
  std::string name;
  std::vector<Input> corpus;
  std::vector<std::string> words;
  // Writes the input as files of a user and parses it. May throw ConfigError or DtmError.
  std::function<void(const Input& input, Scratch& scratch)> run;
};

struct Campaign {
  std::uint64_t seed = 1;
  std::uint64_t first = 0;
  std::uint64_t inputs = std::numeric_limits<std::uint64_t>::max();
  double seconds = 1e9;     // wall time; no batch starts later
  double max_cpu_s = 10.0;  // of one input
  double max_memory_mb = 1024.0;
  std::string findings_dir;  // created on the first finding
};

struct Finding {
  std::uint64_t number = 0;
  std::string what;
  std::string file;  // the input
};

struct Outcome {
  std::uint64_t inputs = 0;
  std::uint64_t refused = 0;
  double seconds = 0.0;
  double worst_cpu_s = 0.0;
  std::uint64_t worst_number = 0;
  double worst_memory_mb = 0.0;
  std::vector<Finding> findings;  // stops after 20
};

Outcome run_inputs(const Parser& parser, const Campaign& campaign);

}  // namespace rover::fuzz
