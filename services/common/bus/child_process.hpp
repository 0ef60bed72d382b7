// Starts programs without a shell, so that text of the user is never interpreted.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace rover {

// Its standard output; nothing if it cannot be started or its exit status is not 0.
std::optional<std::string> output_of(const std::vector<std::string>& command);
// Its exit status; -1 if it cannot be started or is killed. Its output, errors included, goes into the file.
int run_into(const std::string& log_file, const std::vector<std::string>& command);
// The same, with the output of this program.
int run_program(const std::vector<std::string>& command);

}  // namespace rover
