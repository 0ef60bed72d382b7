// Arguments of ./rover run and of each benchmark run.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rover {

struct RunArguments {
  std::string source_dir = ".";         // contains config/ and logs/
  std::string bin_dir;                  // contains the services' executables
  std::string scenario;                 // file; empty for run(): config/scenarios/default.yaml
  std::int64_t seed = -1;               // -1: the scenario's own
  std::string level;                    // efficient, auto or full; empty: the scenario's own
  std::vector<std::string> set;         // file.key.key=value
  std::string out;                      // run folder; empty: logs/<time>-<scenario>
  std::string bus;                      // LCM URL; empty: of config/bus.yaml
  std::string record;                   // full or reduced; empty: of config/recorder.yaml
  std::string perception = "rendered";  // geometric, truth: without cameras, in one process
  bool headless = false;
  bool realtime = false;
  bool allow_injection = false;  // enables ./rover inject; implied by a scenario with faults
};

// The scenario file; the default scenario if none is given.
std::string scenario_file(const RunArguments& arguments);
// File name without folder and extension.
std::string scenario_name(const std::string& file);
// Commit of the sources, with -dirty and a hash of the changes if modified; "unknown" outside a checkout. The tables of
// test/results, which benches write, are no source.
std::string commit_of(const std::string& source_dir);
// "1..10" or "3" or "1,4,7". Throws ConfigError.
std::vector<std::int64_t> parse_seeds(const std::string& text);

}  // namespace rover
