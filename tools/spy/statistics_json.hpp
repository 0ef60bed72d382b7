// Formats traffic statistics as one JSON document.
#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "common/bus/message_fields.hpp"
#include "tools/spy/traffic.hpp"

namespace rover::spy {

// NaN and infinity become null. An array longer than `longest` becomes a text with its length.
nlohmann::ordered_json fields_json(const Fields& fields, size_t longest);
// If `chosen` is not empty: only these channels, with complete arrays.
nlohmann::ordered_json statistics_json(const TrafficStatistics& statistics, const std::string& source,
                                       const std::set<std::string>& chosen);

}  // namespace rover::spy
