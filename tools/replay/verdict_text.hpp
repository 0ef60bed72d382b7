// The verdicts of a check as people read them.
#pragma once

#include <string>
#include <vector>

#include "tools/replay/comparison.hpp"

namespace rover::replay {

// Names the field that differs, empty where it cannot.
using NameField = std::string (*)(const Difference& difference);

// One line: channel, publisher, sequence number, time and what differs first in it.
std::string difference_text(const Difference& difference, NameField name_field);
// One line for each stream, ended by newlines.
std::string verdict_table(const std::vector<StreamVerdict>& verdicts, NameField name_field);

}  // namespace rover::replay
