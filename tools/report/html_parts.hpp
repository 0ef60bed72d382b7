// What the pages of the report share.
#pragma once

#include <optional>
#include <string>

#include "tools/report/run_record.hpp"

namespace rover::report {

// "n/a" where the value is not known.
std::string shown(double value, int decimals, const char* unit = "");
std::string shown(const std::optional<int>& value);
// Class of a cell or card.
std::string verdict(bool known, bool good);
std::string outcome_text(const std::string& outcome);
// Seed, level, commit and how the run was paced, as HTML.
std::string run_facts(const RunInfo& info);

// Maps with switches for their layers, which work without a script.
std::string layered_maps(const std::string& maps);
// The whole document.
std::string document(const std::string& title, const std::string& body);

}  // namespace rover::report
