// Every fault that can be injected, once: what it is done to, what its amount means, who carries it out.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "common/bus/channel_types.hpp"
#include "common/bus/config.hpp"

namespace rover {

enum class FaultTarget {
  kService,  // a process by its service's name; carried out by the simulator or through s6
  kSlow,     // a service whose messages come late; carried out by the taps of all who take them
  kChannel,  // CHANNEL; carried out by the tap of each node that takes it
  kField,    // CHANNEL or CHANNEL.field, numbers with a point; by the taps
  kBus,      // all inputs of all nodes; by the taps
  kWorld,    // sensors, vehicle and clock; carried out by the simulator
  kRecorder
};

struct FaultKind {
  std::string name;
  FaultTarget on;
  std::vector<std::string> targets;  // the possible ones; empty: as FaultTarget says. A single one need not be named.
  std::string unit;                  // of the amount; empty: none is taken
  Range amount;
  double usual;  // amount where none is given; NaN: it must be
  bool lasts;    // takes a duration
  std::string what;
};

const std::vector<FaultKind>& fault_kinds();
// Null where there is none of the name.
const FaultKind* find_fault(const std::string& name);
std::string fault_names();

// A fault that is asked for.
struct FaultOrder {
  std::string fault;
  std::string target;
  double amount = 0.0;
  double for_s = std::numeric_limits<double>::infinity();
};

// What is wrong with the target, in words; empty where nothing is. The types are handed in, as for Node::subscribe_raw.
std::string target_problem(const FaultKind& kind, const std::string& target, FindChannelType types);
std::string amount_problem(const FaultKind& kind, double amount);
// The table as text, one fault a line.
std::string fault_list();

}  // namespace rover
