#include "tools/status/account.hpp"

#include <algorithm>
#include <cmath>

namespace rover::status {

void Account::hear(const Heard& message) {
  StreamAccount& stream = streams_[{message.channel, message.publisher}];
  stream.hear({message.boot_id, message.seq, message.utime, clock_.now(), message.bytes});
}

void Account::hear_tick(const std::string& publisher, Utime utime, double wall_s) {
  if (utime < clock_.now()) *this = Account{};  // another world has begun
  clock_publisher_ = publisher;
  clock_.tick(utime, wall_s);
  const Utime from = clock_.window(wall_s).from;
  for (auto& [key, stream] : streams_) stream.forget_before(from);
}

void Account::hear_heartbeat(const Heartbeat& heartbeat) {
  heartbeats_[heartbeat.service] = heartbeat;
}

void Account::hear_state(const StateReport& state) {
  state_ = state;
}

void Account::hear_fault(const FaultReport& fault) {
  faults_[fault.id] = fault;
}

std::map<std::string, int> Account::pids() const {
  std::map<std::string, int> out;
  for (const auto& [name, heartbeat] : heartbeats_) out[name] = heartbeat.pid;
  return out;
}

Snapshot Account::snapshot(const std::map<std::string, ProcessFigures>& processes, double wall_s) const {
  const Window window = clock_.window(wall_s);
  Snapshot out;
  out.now = clock_.now();
  out.realtime_factor = window.wall_s > 0.0 ? window.message_s / window.wall_s : kNaN;
  out.tick_silence_s = clock_.silence_s(wall_s);
  out.state = state_;
  if (state_) out.state_for_s = clock_.age_s(state_->since);
  out.permit = permit_;
  for (const auto& [name, process] : processes) out.services[name].process = process;
  add_faults(out);
  add_heard_channels(out, window);
  add_channels_of_inputs(out, window);
  add_services(out, window);
  return out;
}

void Account::add_heard_channels(Snapshot& out, const Window& window) const {
  const double per_wall_s = window.wall_s > 0.0 ? 1.0 / window.wall_s : kNaN;
  std::map<std::string, Utime> newest;
  for (const auto& [key, stream] : streams_) {
    const auto [it, is_new] = out.channels.try_emplace(key.first);
    ChannelStatus& channel = it->second;
    if (is_new) channel = {0.0, 0.0, 0.0, kNaN, 0, 0};
    channel.hz += stream.hz(window);
    channel.wall_hz += static_cast<double>(stream.count()) * per_wall_s;
    channel.bytes_per_s += static_cast<double>(stream.bytes()) * per_wall_s;
    channel.gaps += stream.gaps();
    Utime& last = newest.try_emplace(key.first, kNever).first->second;
    last = std::max(last, stream.newest());
    channel.age_s = clock_.age_s(last);
  }
  for (const auto& [name, count] : malformed_) out.channels[name].malformed = count;
}

// A channel that was silent while status listened is known to those who take it.
void Account::add_channels_of_inputs(Snapshot& out, const Window& window) const {
  const double none = window.message_s > 0.0 ? 0.0 : kNaN;
  std::map<std::string, Utime> newest;
  for (const auto& [service, heartbeat] : heartbeats_) {
    for (const auto& [channel, utime] : heartbeat.newest_input) {
      Utime& last = newest.try_emplace(channel, kNever).first->second;
      last = std::max(last, utime);
    }
  }
  for (const auto& [channel, utime] : newest)
    out.channels.try_emplace(channel, ChannelStatus{none, none, none, clock_.age_s(utime), 0, 0});
}

FaultStatus Account::status_of(const FaultReport& fault) const {
  return {fault, clock_.age_s(fault.visible)};
}

// STATE names those that stand, FAULT their figures; what is newer than the last STATE goes before it.
void Account::add_faults(Snapshot& out) const {
  const std::vector<std::string> named = state_ ? state_->faults : std::vector<std::string>{};
  const Utime said = state_ ? state_->utime : kNever;
  for (const std::string& id : named) {
    const auto heard = faults_.find(id);
    FaultReport fault;
    if (heard != faults_.end()) fault = heard->second;
    if (!fault.standing && fault.utime > said) continue;
    fault.id = id;
    fault.standing = true;
    out.faults.push_back(status_of(fault));
  }
  for (const auto& [id, fault] : faults_) {
    const bool listed = std::find(named.begin(), named.end(), id) != named.end();
    if (!listed && fault.standing && fault.utime > said) out.faults.push_back(status_of(fault));
  }
}

void Account::add_services(Snapshot& out, const Window& window) const {
  for (const auto& [name, heartbeat] : heartbeats_) {
    out.services[name].heartbeat = heartbeat;
    out.services[name].age_s = clock_.age_s(heartbeat.utime);
  }
  for (auto& [name, service] : out.services) {
    if (service.heartbeat) continue;
    if (name == clock_publisher_) {
      service.age_s = out.tick_silence_s;
    } else if (window.message_s > 0.0) {
      service.quiet_s = window.message_s;
    }
  }
}

}  // namespace rover::status
