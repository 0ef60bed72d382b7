#include "common/core/barrier.hpp"

#include <algorithm>
#include <utility>

namespace rover {

Barrier::Barrier(const std::vector<std::string>& participants) : names_(participants) {
  for (const std::string& name : participants) members_[name] = {};
}

void Barrier::ready(const std::string& name, std::int64_t boot_id, int pid) {
  const auto it = members_.find(name);
  if (it == members_.end() || boot_id <= it->second.boot_id) return;
  Member& member = it->second;
  if (member.state == State::kWorking) {
    member.successor = Process{boot_id, pid};
    return;
  }
  member.state = State::kReady;
  member.boot_id = boot_id;
  member.pid = pid;
}

void Barrier::done(const std::string& name, std::int64_t boot_id, int pid, Utime tick, Utime promise, bool busy) {
  const auto it = members_.find(name);
  if (it == members_.end() || boot_id < it->second.boot_id) return;
  if (boot_id > it->second.boot_id) return ready(name, boot_id, pid);
  Member& member = it->second;
  if (member.state == State::kAbsent && !member.may_wake) return;
  member.pid = pid;
  if (member.state != State::kWorking) {
    member.state = State::kReady;
    return;
  }
  member.clear_until = std::max({member.clear_until, tick + kTickUs, promise - kTickUs});
  if (!busy) member.finished = std::max(member.finished, tick);
}

std::vector<std::string> Barrier::waiting_for(Utime t) const {
  std::vector<std::string> missing;
  for (const std::string& name : names_) {
    const Member& member = members_.at(name);
    const bool absent = member.state == State::kAbsent && member.awaited && t >= member.up_from;
    const bool late = member.state == State::kWorking && t > member.clear_until;
    if (absent || late) missing.push_back(name);
  }
  return missing;
}

std::vector<std::string> Barrier::admit(Utime t) {
  last_given_ = t;
  std::vector<std::string> taking_part;
  for (const std::string& name : names_) {
    Member& member = members_[name];
    if (member.state == State::kReady && t >= member.expected_from) {
      member.state = State::kWorking;
      member.clear_until = t;
    }
    if (member.state == State::kWorking) taking_part.push_back(name);
  }
  return taking_part;
}

void Barrier::leave(const std::string& name, Cause cause, Utime now, Utime return_after) {
  Member& member = members_.at(name);
  member.state = State::kAbsent;
  member.may_wake = cause == Cause::kSilent;
  if (cause == Cause::kDied) member.pid = 0;
  member.clear_until = member.finished = kNever;
  expect(name, now, return_after);
  if (const auto successor = std::exchange(member.successor, {})) ready(name, successor->boot_id, successor->pid);
}

void Barrier::stop(const std::string& name) {
  leave(name, Cause::kDied, 0, 0);
  give_up(name);
  members_.at(name).expected_from = kNotExpected;
}

void Barrier::expect(const std::string& name, Utime now, Utime return_after) {
  Member& member = members_.at(name);
  member.awaited = true;
  member.up_from = now + return_after / 2;
  member.expected_from = now + return_after;
}

void Barrier::give_up(const std::string& name) {
  members_.at(name).awaited = false;
}

bool Barrier::takes_part(const std::string& name) const {
  const auto it = members_.find(name);
  return it != members_.end() && it->second.state == State::kWorking;
}

bool Barrier::idle(const std::string& name) const {
  return !takes_part(name) || members_.at(name).finished >= last_given_;
}

void Barrier::allow_until(Utime t) {
  for (const std::string& name : names_)
    if (takes_part(name) && idle(name)) members_[name].clear_until = std::max(members_[name].clear_until, t);
}

int Barrier::pid_of(const std::string& name) const {
  const auto it = members_.find(name);
  return it == members_.end() ? 0 : it->second.pid;
}

}  // namespace rover
