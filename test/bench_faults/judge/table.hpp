// The judge's verdicts as the table of test/results/faults_stack.md.
#pragma once

#include <ostream>
#include <vector>

#include "test/bench_faults/judge/judge.hpp"

namespace rover::bench_faults {

struct Heading {
  std::string command;
  std::string commit;
  std::string machine;
};

// False if a requirement is not met.
bool write_table(const Heading& heading, const Settings& settings, const Judge& judge, std::ostream& out);

}  // namespace rover::bench_faults
