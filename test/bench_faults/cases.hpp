// For each row of config/fdir.yaml: causes that make its quantity exceed the limit, and the phases in which they can.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "test/bench_faults/hands.hpp"
#include "test/bench_faults/phase.hpp"

namespace rover::bench_faults {

// One cause, applied to the motor or service `who`; `turn`: number of previous injections of the row.
struct Cause {
  std::string text;
  double longest_s;  // ends when the row is raised, at the latest after this time
  std::function<void(Hands&, const std::string& who, int turn)> begin;
  std::function<void(Hands&, const std::string& who)> end;                  // empty: ends by itself
  std::function<void(Hands&, const std::string& who, double age_s)> go_on;  // each tick; empty: nothing
};

struct Case {
  std::string row;
  std::vector<std::string> who;  // motors or services of the row; empty: none
  std::vector<Phase> phases;
  std::vector<Cause> causes;  // used in turn
  bool full = false;          // at the Full level
};

std::vector<Case> all_cases();

}  // namespace rover::bench_faults
