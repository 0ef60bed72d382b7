// Rows of test/results/wild.md: what people's files and requests did before, and what they do now, as the tests see it.
#pragma once

#include <string>

namespace rover {

// For a test to say once it has seen that all is right. `now` is what was seen: the line of a refusal, or what came
// out. Kept where ./rover bench wild asks for it (ROVER_WILD_ROWS names the file); nothing otherwise.
void wild_row(const std::string& kind, const std::string& input, const std::string& before, const std::string& now);

}  // namespace rover
