// One channel as a CSV table (RFC 4180): a column for each number or text, a row for each message.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "common/bus/message_fields.hpp"

namespace rover::interchange {

// Columns of a message type: "header.utime", "position_m[0]" ... An array whose length varies is one column, its values
// separated by spaces; that of messages is one such column for each of their fields. Pixels of
// pictures and disparities have no column.
std::vector<std::string> csv_columns(const std::string& type);

void write_csv_header(std::ostream& out, const std::vector<std::string>& columns);
void write_csv_row(std::ostream& out, const std::vector<std::string>& columns, const Fields& fields);

}  // namespace rover::interchange
