// Run metadata, report and metrics.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tools/launcher/run_folder.hpp"

namespace rover {

// Invalid UTF-8 is replaced.
void write_json(const std::string& file, const nlohmann::json& facts);
// Returns false and prints a line if it failed.
bool make_report(const std::string& bin_dir, const RunFolder& folder);
// metrics.json; a discarded value if unreadable.
nlohmann::json read_metrics(const RunFolder& folder);
// One metric as text; "-" if absent or null.
std::string figure(const nlohmann::json& metrics, const char* key, int decimals);

}  // namespace rover
