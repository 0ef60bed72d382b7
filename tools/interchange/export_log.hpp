// ./rover export: converts a log to formats of other tools.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace rover::interchange {

inline const std::set<std::string> kExportFormats = {"csv", "tum", "geojson", "mcap"};

struct ExportOptions {
  std::string log;  // log file or run folder
  std::string out;  // folder, new or empty; empty: "export" in the run's folder, or beside
                    // the log as NAME_export
  int log_run = 0;  // selects a run of a log with several; 0: the only one
  std::set<std::string> formats = kExportFormats;  // subset of kExportFormats
  std::set<std::string> channels;                  // empty: all
};

// Returns a summary. Throws ConfigError, also on SIGINT and SIGTERM (interrupt.hpp); then nothing is left.
std::vector<std::string> export_log(const ExportOptions& options);

}  // namespace rover::interchange
