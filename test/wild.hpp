// Rows of test/results/wild.md: behaviour of unusual files and requests, before and now.
#pragma once

#include <string>

namespace rover {

// Call after the checks of a test. `now`: the observed result or refusal. Appends to the file ROVER_WILD_ROWS, which
// ./rover bench wild sets; else does nothing.
void wild_row(const std::string& kind, const std::string& input, const std::string& before, const std::string& now);

}  // namespace rover
