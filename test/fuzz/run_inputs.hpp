// Gives a parser one input after the other, in processes of their own: each crash, hang and waste is one finding.
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
  // Lays the input out as the user would have it, and reads it. May refuse it by ConfigError or DtmError.
  std::function<void(const Input& input, Scratch& scratch)> run;
};

struct Campaign {
  std::uint64_t seed = 1;
  std::uint64_t first = 0;
  std::uint64_t inputs = std::numeric_limits<std::uint64_t>::max();
  double seconds = 1e9;      // of wall time; no batch begins later
  double most_cpu_s = 10.0;  // of one input
  double most_memory_mb = 1024.0;
  std::string findings_dir;  // made where there is something to keep
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
  std::vector<Finding> findings;  // at most 20, then it ends
};

Outcome run_inputs(const Parser& parser, const Campaign& campaign);

}  // namespace rover::fuzz
