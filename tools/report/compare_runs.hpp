// Makes the comparison page of two run folders.
#pragma once

#include <string>

namespace rover::report {

struct RunToCompare {
  std::string dir;
  int log_run = 0;  // selects a run of a log with several; 0: the only one
};

// `out` empty: compare-A-B.html in the current folder. Overwrites only comparison pages. Returns one line. Throws
// ConfigError.
std::string compare_runs(const RunToCompare& run_a, const RunToCompare& run_b, const std::string& default_config_dir,
                         const std::string& out);

}  // namespace rover::report
