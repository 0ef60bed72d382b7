#include "rover_simulator/command_inbox.hpp"

#include <algorithm>
#include <tuple>

#include "common/bus/streams.hpp"

namespace rover {

template <class Command>
auto CommandInbox<Command>::take_released(Utime t) -> std::vector<Pending> {
  const auto later = [t](const Pending& pending) { return pending.release > t; };
  const auto split = std::stable_partition(pending_.begin(), pending_.end(), later);
  std::vector<Pending> released(split, pending_.end());
  pending_.erase(split, pending_.end());
  std::stable_sort(released.begin(), released.end(), [](const Pending& a, const Pending& b) {
    const auto key = [](const Pending& w) {
      return std::tie(w.release, w.command.header.boot_id, w.command.header.seq);
    };
    return key(a) < key(b);
  });
  return released;
}

template <class Command>
void CommandInbox<Command>::inject_faults(const Command& command, FaultInjector& injector,
                                          std::vector<Pending>& ready) {
  for (const FaultInjector::Output& output : injector.apply(channel_, command.header, encoded(command))) {
    Pending next{command.header.release_utime + output.delay, {}, true};
    if (!decode_message(output.bytes.data(), static_cast<int>(output.bytes.size()), next.command)) continue;
    next.command.header = command.header;
    (output.delay > 0 ? pending_ : ready).push_back(std::move(next));
  }
}

template <class Command>
std::optional<Command> CommandInbox<Command>::take(Utime t, FaultInjector* injector) {
  std::vector<Pending> ready;
  for (Pending& pending : take_released(t)) {
    if (injector != nullptr && !pending.fault_injected)
      inject_faults(pending.command, *injector, ready);
    else
      ready.push_back(std::move(pending));
  }
  std::optional<Command> newest;
  for (const Pending& pending : ready) {
    const header_t& header = pending.command.header;
    if (std::tie(header.boot_id, header.seq) <= std::tie(boot_id_, seq_)) continue;
    boot_id_ = header.boot_id;
    seq_ = header.seq;
    newest = pending.command;
  }
  return newest;
}

template class CommandInbox<wheel_command_t>;
template class CommandInbox<ptu_command_t>;

}  // namespace rover
