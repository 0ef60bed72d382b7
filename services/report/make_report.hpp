// From a run's folder to its figures and pictures.
#pragma once

#include <optional>
#include <string>

#include "report/relief.hpp"
#include "report/run_folder.hpp"

namespace rover::report {

// Writes metrics.json, report.html, traverse.svg and traverse.png into the folder. Returns one line that sums up.
std::string make_report(const std::string& run_dir, const std::string& default_config_dir);
// The same where log and ground are at hand already.
std::string write_report(const RunFolder& folder, const RunRecord& run, const std::optional<TrueWorld>& world,
                         const HeightRaster& orbital);

}  // namespace rover::report
