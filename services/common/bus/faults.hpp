// Table of all faults that can be injected: target, unit and range of the amount, and who carries it out.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "common/bus/channel_types.hpp"
#include "common/bus/config.hpp"

namespace rover {

enum class FaultTarget {
  kService,  // a process by its service's name; carried out by the simulator or through s6
  kSlow,     // a service whose messages are delayed; by the fault injectors of their subscribers
  kChannel,  // CHANNEL; by the fault injectors of its subscribers
  kField,    // CHANNEL or CHANNEL.field (floating point); by the fault injectors
  kBus,      // all inputs of all nodes; by the fault injectors
  kWorld,    // sensors, vehicle and clock; carried out by the simulator
  kRecorder
};

struct FaultKind {
  std::string name;
  FaultTarget on;
  std::vector<std::string> targets;  // allowed targets; empty: by FaultTarget. A single one is the default.
  std::string unit;                  // of the amount; empty: no amount
  Range amount;
  double default_amount;  // NaN: the amount is required
  bool has_duration;      // accepts a duration
  std::string description;
};

const std::vector<FaultKind>& fault_kinds();
// Null if there is no such fault.
const FaultKind* find_fault(const std::string& name);
std::string fault_names();

// A requested fault.
struct FaultRequest {
  std::string fault;
  std::string target;
  double amount = 0.0;
  double for_s = std::numeric_limits<double>::infinity();
};

// Error text; empty if the target is valid. `types`: as for Node::subscribe_raw.
std::string target_problem(const FaultKind& kind, const std::string& target, FindChannelType types);
std::string amount_problem(const FaultKind& kind, double amount);
// The table as text, one fault per line.
std::string fault_list();

}  // namespace rover
