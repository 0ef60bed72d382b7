#include "tools/status/bus_statistics.hpp"

#include <algorithm>
#include <cmath>

namespace rover::status {

void BusStatistics::add_message(const MessageInfo& message) {
  StreamStatistics& stream = streams_[{message.channel, message.publisher}];
  stream.add({message.boot_id, message.seq, message.utime, clock_.now(), message.bytes});
}

void BusStatistics::add_tick(const std::string& publisher, Utime utime, double wall_s) {
  if (utime < clock_.now()) *this = BusStatistics{};  // time went back: a new run
  clock_publisher_ = publisher;
  clock_.tick(utime, wall_s);
  const Utime from = clock_.window(wall_s).from;
  for (auto& [key, stream] : streams_) stream.remove_before(from);
}

void BusStatistics::add_heartbeat(const Heartbeat& heartbeat) {
  heartbeats_[heartbeat.service] = heartbeat;
}

void BusStatistics::add_state(const StateReport& state) {
  state_ = state;
}

void BusStatistics::add_fault(const FaultReport& fault) {
  faults_[fault.id] = fault;
}

std::map<std::string, int> BusStatistics::pids() const {
  std::map<std::string, int> out;
  for (const auto& [name, heartbeat] : heartbeats_) out[name] = heartbeat.pid;
  return out;
}

Snapshot BusStatistics::snapshot(const std::map<std::string, ProcessFigures>& processes, double wall_s) const {
  const Window window = clock_.window(wall_s);
  Snapshot out;
  out.now = clock_.now();
  out.realtime_factor = window.wall_s > 0.0 ? window.message_s / window.wall_s : kNaN;
  out.tick_silence_s = clock_.tick_age_s(wall_s);
  out.state = state_;
  if (state_) out.state_for_s = clock_.age_s(state_->since);
  out.permit = permit_;
  for (const auto& [name, process] : processes) out.services[name].process = process;
  add_faults(out);
  add_received_channels(out, window);
  add_channels_of_inputs(out, window);
  add_services(out, window);
  return out;
}

void BusStatistics::add_received_channels(Snapshot& out, const Window& window) const {
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

// Channels that were silent while listening are known from the heartbeats of their subscribers.
void BusStatistics::add_channels_of_inputs(Snapshot& out, const Window& window) const {
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

FaultStatus BusStatistics::status_of(const FaultReport& fault) const {
  return {fault, clock_.age_s(fault.visible)};
}

// STATE lists the active faults, FAULT their values; a FAULT newer than the last STATE has priority.
void BusStatistics::add_faults(Snapshot& out) const {
  const std::vector<std::string> named = state_ ? state_->faults : std::vector<std::string>{};
  const Utime state_utime = state_ ? state_->utime : kNever;
  for (const std::string& id : named) {
    const auto received = faults_.find(id);
    FaultReport fault;
    if (received != faults_.end()) fault = received->second;
    if (!fault.active && fault.utime > state_utime) continue;
    fault.id = id;
    fault.active = true;
    out.faults.push_back(status_of(fault));
  }
  for (const auto& [id, fault] : faults_) {
    const bool listed = std::find(named.begin(), named.end(), id) != named.end();
    if (!listed && fault.active && fault.utime > state_utime) out.faults.push_back(status_of(fault));
  }
}

void BusStatistics::add_services(Snapshot& out, const Window& window) const {
  for (const auto& [name, heartbeat] : heartbeats_) {
    out.services[name].heartbeat = heartbeat;
    out.services[name].age_s = clock_.age_s(heartbeat.utime);
  }
  for (auto& [name, service] : out.services) {
    service.wanted =
        !state_ || std::find(state_->stopped.begin(), state_->stopped.end(), name) == state_->stopped.end();
    if (service.heartbeat) continue;
    if (name == clock_publisher_) {
      service.age_s = out.tick_silence_s;
    } else if (window.message_s > 0.0) {
      service.quiet_s = window.message_s;
    }
  }
}

}  // namespace rover::status
