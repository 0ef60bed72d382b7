#include "mission_control/station.hpp"

namespace rover::mission {
namespace {

constexpr size_t kMostWaiting = 16;

}  // namespace

Answer Desk::give(const Command& command, std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  if (entries_.size() >= kMostWaiting && !stops(command.kind))
    return {Answer::Outcome::kBusy, -1, "too many commands wait"};
  const std::int64_t ticket = next_ticket_++;
  entries_[ticket].command = command;
  changed_.wait_for(lock, patience, [&] { return entries_[ticket].answer.has_value(); });
  return outcome_of(ticket);
}

Answer Desk::outcome_of(std::int64_t ticket) {
  Entry& entry = entries_[ticket];
  if (entry.answer) {
    const Answer answer = *entry.answer;
    entries_.erase(ticket);
    return answer;
  }
  entry.abandoned = true;
  if (entry.taken) return {Answer::Outcome::kSilence, entry.command_id, "given, but not answered"};
  if (stops(entry.command.kind)) return {Answer::Outcome::kNoTime, -1, "the rover's time stands still; it waits"};
  entries_.erase(ticket);
  return {Answer::Outcome::kNoTime, -1, "the rover's time stands still; withdrawn"};
}

std::optional<Desk::Waiting> Desk::take() {
  const std::lock_guard lock(mutex_);
  for (auto& [ticket, entry] : entries_) {
    if (entry.taken) continue;
    entry.taken = true;
    return Waiting{ticket, entry.command};
  }
  return std::nullopt;
}

void Desk::given(std::int64_t ticket, std::int64_t command_id) {
  const std::lock_guard lock(mutex_);
  if (const auto it = entries_.find(ticket); it != entries_.end()) it->second.command_id = command_id;
}

std::optional<Command> Desk::answered(std::int64_t command_id, bool accepted, const std::string& reason) {
  const std::lock_guard lock(mutex_);
  for (auto it = entries_.begin(); it != entries_.end(); ++it) {
    Entry& entry = it->second;
    if (entry.command_id != command_id || entry.answer) continue;
    const Command command = entry.command;
    entry.answer = Answer{accepted ? Answer::Outcome::kAccepted : Answer::Outcome::kRefused, command_id, reason};
    if (entry.abandoned) entries_.erase(it);
    changed_.notify_all();
    return command;
  }
  return std::nullopt;
}

}  // namespace rover::mission
