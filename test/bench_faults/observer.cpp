#include "test/bench_faults/observer.hpp"

#include "common/bus/channels.hpp"

namespace rover::bench_faults {

Observer::Observer(lcm::LCM& bus) {
  keep(bus, channel::kState, state_);
  keep(bus, channel::kPlannerStatus, planner_);
  keep(bus, channel::kControlStatus, control_);
  bus.subscribeFunction(
         channel::kFault,
         +[](const lcm::ReceiveBuffer*, const std::string&, const fault_t* fault, Observer* self) {
           self->take(*fault);
         },
         this)
      ->setQueueCapacity(0);
}

template <class Message>
void Observer::keep(lcm::LCM& bus, const char* channel, Message& newest) {
  bus.subscribeFunction(
         channel,
         +[](const lcm::ReceiveBuffer*, const std::string&, const Message* message, Message* out) { *out = *message; },
         &newest)
      ->setQueueCapacity(0);
}

void Observer::take(const fault_t& fault) {
  if (fault.active)
    active_[fault.id] = fault.response;
  else
    active_.erase(fault.id);
}

std::optional<Phase> Observer::phase() const {
  return phase_of(state_.state, planner_.state, control_.state);
}

}  // namespace rover::bench_faults
