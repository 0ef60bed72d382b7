// From two runs' folders to the page that compares them.
#pragma once

#include <string>

namespace rover::report {

struct RunToCompare {
  std::string dir;
  int log_run = 0;  // of a log that holds several runs; 0: the only one
};

// `out` empty: compare-A-B.html in the current folder. Never overwrites a file that is no such page. Returns one line.
// Throws ConfigError.
std::string compare_runs(const RunToCompare& run_a, const RunToCompare& run_b, const std::string& default_config_dir,
                         const std::string& out);

}  // namespace rover::report
