// From two runs' folders to the page that compares them.
#pragma once

#include <string>

namespace rover::report {

// `out` empty: compare-A-B.html in the current folder. Never overwrites a file that is no such page. Returns one line.
// Throws ConfigError.
std::string compare_runs(const std::string& dir_a, const std::string& dir_b, const std::string& default_config_dir,
                         const std::string& out);

}  // namespace rover::report
