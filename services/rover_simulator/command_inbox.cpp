#include "rover_simulator/command_inbox.hpp"

#include <algorithm>
#include <tuple>

#include "common/bus/streams.hpp"

namespace rover {

template <class Command>
auto CommandInbox<Command>::take_released(Utime t) -> std::vector<Waiting> {
  const auto later = [t](const Waiting& waiting) { return waiting.release > t; };
  const auto split = std::stable_partition(waiting_.begin(), waiting_.end(), later);
  std::vector<Waiting> released(split, waiting_.end());
  waiting_.erase(split, waiting_.end());
  std::stable_sort(released.begin(), released.end(), [](const Waiting& a, const Waiting& b) {
    const auto key = [](const Waiting& w) {
      return std::tie(w.release, w.command.header.boot_id, w.command.header.seq);
    };
    return key(a) < key(b);
  });
  return released;
}

template <class Command>
void CommandInbox<Command>::pass(const Command& command, Tap& tap, std::vector<Waiting>& passed) {
  for (const Tap::Passed& through : tap.pass(channel_, command.header, encoded(command))) {
    Waiting next{command.header.release_utime + through.delay, {}, true};
    if (!decode_message(through.bytes.data(), static_cast<int>(through.bytes.size()), next.command)) continue;
    next.command.header = command.header;
    (through.delay > 0 ? waiting_ : passed).push_back(std::move(next));
  }
}

template <class Command>
std::optional<Command> CommandInbox<Command>::take(Utime t, Tap* tap) {
  std::vector<Waiting> passed;
  for (Waiting& waiting : take_released(t)) {
    if (tap != nullptr && !waiting.tapped)
      pass(waiting.command, *tap, passed);
    else
      passed.push_back(std::move(waiting));
  }
  std::optional<Command> newest;
  for (const Waiting& waiting : passed) {
    const header_t& header = waiting.command.header;
    if (std::tie(header.boot_id, header.seq) <= std::tie(boot_id_, seq_)) continue;
    boot_id_ = header.boot_id;
    seq_ = header.seq;
    newest = waiting.command;
  }
  return newest;
}

template class CommandInbox<wheel_command_t>;
template class CommandInbox<ptu_command_t>;

}  // namespace rover
