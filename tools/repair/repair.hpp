// Makes a damaged log whole: keeps every whole record, leaves out what is between and behind them.
#pragma once

#include <string>

namespace rover::recorder {

struct RepairArguments {
  std::string log;        // a log with its parts, or a run's folder
  std::string out;        // empty: beside it as NAME.repaired.lcm
  bool in_place = false;  // replace the damaged one
};

// Prints a line for each part. Throws ConfigError, and then nothing has been written.
void repair(const RepairArguments& arguments);

}  // namespace rover::recorder
