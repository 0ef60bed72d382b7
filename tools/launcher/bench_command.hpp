// ./rover bench seed, default: runs scenarios over seeds and aggregates the results into a table.
#pragma once

#include <string>
#include <vector>

#include "tools/launcher/arguments.hpp"

namespace rover {

struct BenchArguments {
  RunArguments run;  // source and bin folders, settings that hold for each run
  std::string suite = "seed";
  std::string seeds;    // "1..10" or "1,4,7"; empty: the suite's
  bool resume = false;  // keep the rows of the same commit, level and settings
  int jobs = 1;         // parallel runs, each on its own bus
  std::string command;  // as given, for the table
};

int bench(const BenchArguments& arguments);

}  // namespace rover
