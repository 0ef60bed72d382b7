// Writes a channel as a CSV table (RFC 4180): one column per number or text, one row per message.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "common/bus/message_fields.hpp"

namespace rover::interchange {

// Columns: "header.utime", "position_m[0]" ... A variable-length array is one space-separated column (per field for
// messages). No pixels.
std::vector<std::string> csv_columns(const std::string& type);

void write_csv_header(std::ostream& out, const std::vector<std::string>& columns);
void write_csv_row(std::ostream& out, const std::vector<std::string>& columns, const Fields& fields);

}  // namespace rover::interchange
