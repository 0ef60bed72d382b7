#include "mission_control/shared_state.hpp"

#include <algorithm>

namespace rover::mission {
namespace {

constexpr std::ptrdiff_t kMaxPending = 16;
constexpr std::ptrdiff_t kMaxLate = 4;  // of a kind, whose callers timed out

}  // namespace

CommandReply CommandQueue::submit(const Command& command, std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  drop_late(command.kind);
  const auto pending =
      std::count_if(entries_.begin(), entries_.end(), [](const auto& e) { return !e.second.caller_gone; });
  if (pending >= kMaxPending && !stops(command.kind))
    return {CommandReply::Outcome::kBusy, -1, "too many commands are pending"};
  const std::int64_t ticket = next_ticket_++;
  entries_[ticket].command = command;
  changed_.wait_for(lock, timeout, [&] { return entries_[ticket].answer.has_value(); });
  return take_reply(ticket);
}

// Newer ones of the same kind remain, so an unsent stop is never lost.
void CommandQueue::drop_late(CommandKind kind) {
  const auto late = [kind](const auto& e) { return e.second.caller_gone && e.second.command.kind == kind; };
  while (std::count_if(entries_.begin(), entries_.end(), late) > kMaxLate)
    entries_.erase(std::find_if(entries_.begin(), entries_.end(), late));
}

CommandReply CommandQueue::take_reply(std::int64_t ticket) {
  Entry& entry = entries_[ticket];
  if (entry.answer) {
    const CommandReply answer = *entry.answer;
    entries_.erase(ticket);
    return answer;
  }
  entry.caller_gone = true;
  if (entry.sent) return {CommandReply::Outcome::kNoReply, entry.command_id, "sent, but not acknowledged"};
  if (stops(entry.command.kind))
    return {CommandReply::Outcome::kClockStopped, -1, "the rover's clock has stopped; the command stays queued"};
  entries_.erase(ticket);
  return {CommandReply::Outcome::kClockStopped, -1, "the rover's clock has stopped; the command was withdrawn"};
}

std::optional<CommandQueue::Pending> CommandQueue::next() {
  const std::lock_guard lock(mutex_);
  for (auto& [ticket, entry] : entries_) {
    if (entry.sent) continue;
    entry.sent = true;
    return Pending{ticket, entry.command};
  }
  return std::nullopt;
}

void CommandQueue::set_command_id(std::int64_t ticket, std::int64_t command_id) {
  const std::lock_guard lock(mutex_);
  if (const auto it = entries_.find(ticket); it != entries_.end()) it->second.command_id = command_id;
}

std::optional<Command> CommandQueue::acknowledge(std::int64_t command_id, bool accepted, const std::string& reason) {
  const std::lock_guard lock(mutex_);
  for (auto it = entries_.begin(); it != entries_.end(); ++it) {
    Entry& entry = it->second;
    if (entry.command_id != command_id || entry.answer) continue;
    const Command command = entry.command;
    entry.answer =
        CommandReply{accepted ? CommandReply::Outcome::kAccepted : CommandReply::Outcome::kRefused, command_id, reason};
    if (entry.caller_gone) entries_.erase(it);
    changed_.notify_all();
    return command;
  }
  return std::nullopt;
}

}  // namespace rover::mission
