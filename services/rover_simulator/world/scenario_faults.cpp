#include "rover_simulator/world/scenario_faults.hpp"

#include <cmath>

#include "common/bus/state_names.hpp"

namespace rover {
namespace {

constexpr double kMaxTrigger = 1e6;  // [s] or [m]

void read_trigger(const Config& config, ScriptedFault& fault) {
  std::string first;
  for (const char* key : {"at_s", "after_m", "at_state"}) {
    if (!config.has(key)) continue;
    if (!first.empty()) config.fail(key, "only one trigger is allowed, and " + first + " is given");
    first = key;
  }
  if (first.empty()) config.fail("at_s", "missing; or after_m, or at_state");
  if (first == "at_s") fault.at_s = config.number(first, {0, kMaxTrigger});
  if (first == "after_m") fault.after_m = config.number(first, {0, kMaxTrigger});
  if (first == "at_state") fault.at_state = state_value(config.one_of(first, state_names()));
}

FaultRequest read_order(const Config& config) {
  FaultRequest order;
  order.fault = config.text("fault");
  const FaultKind* kind = find_fault(order.fault);
  if (kind == nullptr) config.fail("fault", "'" + order.fault + "' is not one of " + fault_names());
  order.target = kind->targets.size() == 1 && !config.has("target") ? kind->targets.front() : config.text("target");
  const std::string problem = target_problem(*kind, order.target, find_channel_type);
  if (!problem.empty()) config.fail("target", problem);
  if (kind->unit.empty() && config.has("amount")) config.fail("amount", order.fault + " takes no amount");
  order.amount = kind->default_amount;
  if (config.has("amount") || std::isnan(kind->default_amount)) order.amount = config.number("amount", kind->amount);
  if (!kind->has_duration && config.has("for_s")) config.fail("for_s", order.fault + " takes no duration");
  config.read("for_s", order.for_s, {0.02, kMaxTrigger});
  return order;
}

}  // namespace

std::vector<ScriptedFault> read_faults(const Config& scenario) {
  std::vector<ScriptedFault> faults;
  if (!scenario.has("faults")) return faults;
  for (const Config& item : scenario.list("faults")) {
    ScriptedFault fault;
    fault.order = read_order(item);
    read_trigger(item, fault);
    faults.push_back(fault);
  }
  return faults;
}

}  // namespace rover
