#include "rover_simulator/process_faults.hpp"

#include <csignal>

namespace rover {
namespace {

constexpr Utime kBackAfter = 1'000'000;
constexpr Utime kBackAfterHang = 3'000'000;  // includes the time for detecting and killing the hung process

}  // namespace

void ProcessFaults::order(const FaultOrder& order) {
  if (order.fault == "hang") {
    waiting_.push_back({{order.target, SIGSTOP, kBackAfterHang}});
    return;
  }
  const int times = order.fault == "restart_loop" ? static_cast<int>(order.amount) : 1;
  waiting_.push_back({{order.target, SIGKILL, kBackAfter}, times});
}

std::vector<ProcessBlow> ProcessFaults::take_due(const Barrier& barrier) {
  std::vector<ProcessBlow> due;
  std::erase_if(waiting_, [&](Waiting& waiting) {
    if (!barrier.takes_part(waiting.blow.service)) return false;
    due.push_back(waiting.blow);
    return --waiting.times == 0;
  });
  return due;
}

}  // namespace rover
