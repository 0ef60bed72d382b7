// HTML parts shared by the report and the comparison page.
#pragma once

#include <optional>
#include <string>

#include "tools/report/run_record.hpp"

namespace rover::report {

struct Metrics;

// "n/a" if unknown.
std::string shown(double value, int decimals, const char* unit = "");
std::string shown(const std::optional<int>& value);
// CSS class of a cell or card.
std::string verdict(bool known, bool good);
std::string outcome_text(const std::string& outcome);
// Seed, level, commit and pacing of the run, as HTML.
std::string run_facts(const RunInfo& info);
// What the metrics lack and why, as paragraphs of one line.
std::string remarks(const Metrics& m);

// Maps with layer switches that need no script.
std::string layered_maps(const std::string& maps);
// The whole document.
std::string document(const std::string& title, const std::string& body);

}  // namespace rover::report
