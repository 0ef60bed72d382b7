// ./rover bench seed: runs of scenarios over seeds, kept as rows, aggregated into a table.
#pragma once

#include <string>
#include <vector>

#include "tools/launcher/arguments.hpp"

namespace rover {

struct BenchArguments {
  RunArguments run;  // source and bin folders, settings that hold for each run
  std::string suite = "seed";
  std::vector<std::int64_t> seeds;
  bool resume = false;  // keep the rows that this commit already has
  int jobs = 1;         // runs at a time, each on a bus of its own
  std::string command;  // as given, for the table
};

int bench(const BenchArguments& arguments);

}  // namespace rover
