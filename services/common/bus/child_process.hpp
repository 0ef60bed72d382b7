// Programs started by their argument vectors, so that no shell ever reads a text of the user's.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace rover {

// What it prints; nothing where it cannot be started or ends with another status than 0.
std::optional<std::string> output_of(const std::vector<std::string>& command);
// Its exit status, -1 where it cannot be started or is killed. What it prints, errors included, goes into the file.
int run_into(const std::string& log_file, const std::vector<std::string>& command);
// Its exit status as above; it prints where this program does.
int run_program(const std::vector<std::string>& command);

}  // namespace rover
