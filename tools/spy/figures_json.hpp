// What was heard as one JSON document.
#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "common/bus/message_fields.hpp"
#include "tools/spy/traffic.hpp"

namespace rover::spy {

// NaN and infinity are null. An array of more than `longest` values is its length as a text.
nlohmann::ordered_json fields_json(const Fields& fields, size_t longest);
// `chosen` not empty: these channels alone, and their arrays whole.
nlohmann::ordered_json figures_json(const Figures& figures, const std::string& source,
                                    const std::set<std::string>& chosen);

}  // namespace rover::spy
