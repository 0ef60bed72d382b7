// Repairs a damaged log: copies every valid record, drops the bytes between and after them.
#pragma once

#include <string>

namespace rover::recorder {

struct RepairArguments {
  std::string log;        // log file with its parts, or a run folder
  std::string out;        // empty: NAME.repaired.lcm beside the log
  bool in_place = false;  // replace the damaged log
};

// Prints one line for each part. Throws ConfigError; then nothing was written.
void repair(const RepairArguments& arguments);

}  // namespace rover::recorder
