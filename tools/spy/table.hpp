// Formats traffic statistics as a table with one row for each channel, or as the fields of selected channels.
#pragma once

#include <set>
#include <string>

#include "tools/spy/traffic.hpp"
#include "tools/status/screen.hpp"

namespace rover::spy {

// Newline-terminated lines. `source`: name of the bus or log. `chosen` not empty: all fields of these channels.
std::string table(const TrafficStatistics& statistics, const std::string& source, const std::set<std::string>& chosen,
                  const status::ScreenOptions& options);

}  // namespace rover::spy
