// Which run's services are being kept now.
#pragma once

#include <optional>
#include <string>

namespace rover::status {

// Whether s6 keeps the services of the run's folder.
bool is_running(const std::string& run_dir);
// The one begun last of those that run, in the folder of runs and the folders below it.
std::optional<std::string> newest_running(const std::string& logs_dir);

}  // namespace rover::status
