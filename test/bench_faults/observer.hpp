// Observes the stack to decide when to inject and when the stack has recovered.
#pragma once

#include <lcm/lcm-cpp.hpp>
#include <map>
#include <optional>
#include <rover/control_status_t.hpp>
#include <rover/drive_permit_t.hpp>
#include <rover/fault_t.hpp>
#include <rover/planner_status_t.hpp>
#include <rover/supervisor_state_t.hpp>
#include <string>

#include "test/bench_faults/phase.hpp"

namespace rover::bench_faults {

class Observer {
 public:
  explicit Observer(lcm::LCM& bus);

  // Current phase of the rover; none in transitions.
  std::optional<Phase> phase() const;
  const supervisor_state_t& state() const { return state_; }
  const planner_status_t& planner() const { return planner_; }
  // Ids and responses of the active rows.
  const std::map<std::string, std::int8_t>& active_faults() const { return active_; }

 private:
  template <class Message>
  void keep(lcm::LCM& bus, const char* channel, Message& newest);
  void take(const fault_t& fault);

  supervisor_state_t state_{};
  planner_status_t planner_{};
  control_status_t control_{};
  std::map<std::string, std::int8_t> active_;
};

}  // namespace rover::bench_faults
