// Formats comparison results as text.
#pragma once

#include <string>
#include <vector>

#include "tools/replay/comparison.hpp"

namespace rover::replay {

// Returns the name of the differing field; empty if unknown.
using NameField = std::string (*)(const Difference& difference);

// One line: channel, publisher, sequence number, release time, first differing field or byte.
std::string difference_text(const Difference& difference, NameField name_field);
// One newline-terminated line for each stream.
std::string comparison_table(const std::vector<StreamComparison>& results, NameField name_field);

}  // namespace rover::replay
