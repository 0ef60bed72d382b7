// ./rover export: a log in the formats of other tools.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace rover::interchange {

inline const std::set<std::string> kExportFormats = {"csv", "tum", "geojson", "mcap"};

struct ExportOptions {
  std::string log;  // file, or a run's folder
  std::string out;  // folder, new or empty; empty: "export" in the run's folder, or beside
                    // the log as NAME_export
  int log_run = 0;  // of a log that holds several runs; 0: the only one
  std::set<std::string> formats = kExportFormats;  // of these
  std::set<std::string> channels;                  // empty: all
};

// Lines that say what was written and what was left out. Throws ConfigError with one line, also where the process is
// told to end (interrupt.hpp); nothing is left then.
std::vector<std::string> export_log(const ExportOptions& options);

}  // namespace rover::interchange
