// For each row of config/fdir.yaml: the causes that make its quantity go bad, and when they can.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "test/bench_faults/hands.hpp"
#include "test/bench_faults/phase.hpp"

namespace rover::bench_faults {

// One cause, done to the motor or service that `who` names; `turn` counts the injections of the row.
struct Cause {
  std::string text;
  double longest_s;  // ends when the row is raised, or after that time
  std::function<void(Hands&, const std::string& who, int turn)> begin;
  std::function<void(Hands&, const std::string& who)> end;                  // empty: it ends by itself
  std::function<void(Hands&, const std::string& who, double age_s)> go_on;  // each tick; empty: nothing
};

struct Case {
  std::string row;
  std::vector<std::string> who;  // the row's motors or services; empty: the row is one
  std::vector<Phase> phases;
  std::vector<Cause> causes;  // taken in turn
  bool full = false;          // at the Full level
};

std::vector<Case> all_cases();

}  // namespace rover::bench_faults
