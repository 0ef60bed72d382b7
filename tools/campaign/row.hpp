// A row: the result of one drive of a campaign. As JSON it is one line of rows.jsonl.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace rover::campaign {

// Axis -> value, both as in the campaign file; numbers in their shortest form: 0.05, 5, 12.5. Always has "scenario"
// (the base's name without folder). A cell of slope_deg 0 has slope_direction "flat", whatever directions its block
// lists.
using Cell = std::map<std::string, std::string>;

// Key: commit, cell, seed.
struct Row {
  std::string commit;
  Cell cell;
  std::int64_t seed = 0;
  int attempts = 1;
  std::string status;                     // done, or died: no metrics after two attempts
  std::string outcome;                    // of metrics.json, as goal_reached; empty if died
  std::map<std::string, double> figures;  // scalar numbers of metrics.json, nested ones with '.': "seconds.curve";
                                          // false and true are 0 and 1; null ones are absent, as are "services",
                                          // "realtime_factor" and "wall_s": equal drives have equal rows
  std::map<std::string, std::string>
      texts;  // scalar texts of metrics.json; "fault": the last one that stopped the rover; if died "reason"
  bool operator==(const Row&) const = default;
};

// A number in its shortest form, other text as it is: "5.0" is "5", "5e-2" is "0.05".
std::string short_value(const std::string& text);

// Canonical text of a cell: JSON with sorted keys.
std::string cell_text(const Cell& cell);
Cell parse_cell(const std::string& text);

// The scalar members of metrics.json go into figures, texts and outcome.
void add_metrics(const nlohmann::json& metrics, Row& row);

// One line without line feed.
std::string json_line(const Row& row);
// Throws ConfigError, which begins with `where` (as "rows.jsonl:7"), unless the text is a complete row.
Row parse_row(const std::string& line, const std::string& where);

}  // namespace rover::campaign
