// From a run's folder to its figures and pictures.
#pragma once

#include <string>

#include "tools/report/study.hpp"

namespace rover::report {

// Writes metrics.json, report.html, traverse.svg and traverse.png into the folder. Returns one line that sums up.
std::string make_report(const std::string& run_dir, const std::string& default_config_dir, int log_run = 0);
// The same of a run that has been judged already.
std::string write_report(const Study& study);

}  // namespace rover::report
