// Formats the result of the conformance test as text.
#pragma once

#include <string>
#include <vector>

#include "tools/conform/checks.hpp"

namespace rover::conform {

std::string table(const std::vector<Line>& lines, bool colours);
int failures(const std::vector<Line>& lines);

}  // namespace rover::conform
