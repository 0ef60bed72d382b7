// Finds the run whose services are running.
#pragma once

#include <optional>
#include <string>

namespace rover::status {

// True if s6 runs the services of this run folder.
bool is_running(const std::string& run_dir);
// The most recently started of the running runs, in this folder and below it.
std::optional<std::string> newest_running(const std::string& logs_dir);

}  // namespace rover::status
