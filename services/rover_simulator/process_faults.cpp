#include "rover_simulator/process_faults.hpp"

#include <csignal>

namespace rover {
namespace {

constexpr Utime kAbsenceAfterKill = 1'000'000;
constexpr Utime kAbsenceAfterHang = 3'000'000;  // includes the time for detecting and killing the hung process

}  // namespace

void ProcessFaults::order(const FaultRequest& order) {
  if (order.fault == "hang") {
    pending_.push_back({{order.target, SIGSTOP, kAbsenceAfterHang}});
    return;
  }
  const int times = order.fault == "restart_loop" ? static_cast<int>(order.amount) : 1;
  pending_.push_back({{order.target, SIGKILL, kAbsenceAfterKill}, times});
}

std::vector<ProcessSignal> ProcessFaults::take_due(const Barrier& barrier) {
  std::vector<ProcessSignal> due;
  std::erase_if(pending_, [&](Pending& pending) {
    if (!barrier.takes_part(pending.signal_order.service)) return false;
    due.push_back(pending.signal_order);
    return --pending.times == 0;
  });
  return due;
}

}  // namespace rover
