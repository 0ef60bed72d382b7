// Makes metrics and pictures of a run folder.
#pragma once

#include <string>

#include "tools/report/study.hpp"

namespace rover::report {

// Writes metrics.json, report.html, traverse.svg and traverse.png into the folder. Returns a one-line summary.
std::string make_report(const std::string& run_dir, const std::string& default_config_dir, int log_run = 0);
// The same for a run that is already evaluated.
std::string write_report(const Study& study);

}  // namespace rover::report
