// What a run leaves beside its log: facts, the report and its figures.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tools/launcher/run_folder.hpp"

namespace rover {

// Names that are no UTF-8 are written as far as they are.
void write_json(const std::string& file, const nlohmann::json& facts);
// False where it failed; that is said on the terminal.
bool make_report(const std::string& bin_dir, const RunFolder& folder);
// metrics.json; discarded where it cannot be read.
nlohmann::json read_metrics(const RunFolder& folder);
// A figure of it, 0 where it is absent or null.
double figure(const nlohmann::json& metrics, const char* key);

}  // namespace rover
