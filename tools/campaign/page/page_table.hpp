// The answer of a campaign as Markdown, for test/results.
#pragma once

#include <string>

#include "tools/campaign/page/page_html.hpp"

namespace rover::campaign {

// `picture`: file of the heat map, relative to the table's. A campaign of one cell has none, but the list of its
// drives.
std::string page_table(const PageInfo& info, const Panels& panels, const Drives& drives, const std::string& picture);

// Cells of one line of a Markdown table, with its pipes escaped.
std::string markdown_line(const std::vector<std::string>& cells);
std::string markdown_rule(size_t columns);

}  // namespace rover::campaign
