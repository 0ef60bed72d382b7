// What was heard as a table, one row a channel, or as the fields of chosen channels.
#pragma once

#include <set>
#include <string>

#include "tools/spy/traffic.hpp"
#include "tools/status/screen.hpp"

namespace rover::spy {

// Lines that end with a newline each. `source`: the bus or the log. `chosen` not empty: these channels, with all
// fields.
std::string table(const Figures& figures, const std::string& source, const std::set<std::string>& chosen,
                  const status::ScreenOptions& options);

}  // namespace rover::spy
