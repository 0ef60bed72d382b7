// Test harness for one node: publishes ticks and inputs, records one output and the heartbeats.
#pragma once

#include <lcm/lcm-cpp.hpp>
#include <rover/heartbeat_t.hpp>
#include <string>
#include <vector>

#include "common/bus/node.hpp"
#include "common/bus/streams.hpp"

namespace rover::test {

class OneNodeWorld {
 public:
  // `run_dir`: folder of the node's checkpoint; empty: no checkpoint.
  explicit OneNodeWorld(const std::string& service, const std::string& run_dir = "")
      : bus_("memq://"), world_("world", 1), node_({.name = service, .run_dir = run_dir}, bus_) {
    record(channel::kHeartbeat, heartbeats_);
  }

  Node& node() { return node_; }
  lcm::LCM& bus() { return bus_; }

  // Collects what the node publishes on the channel.
  template <class Message>
  void record(const std::string& channel, std::vector<Message>& out) {
    bus_.subscribeFunction(
        channel,
        +[](const lcm::ReceiveBuffer* buffer, const std::string&, std::vector<Message>* messages) {
          Message message;
          if (decode_message(buffer->data, static_cast<int>(buffer->data_size), message)) messages->push_back(message);
        },
        &out);
  }

  // Released at its measurement time, unless a time is given.
  template <class Message>
  void send(const std::string& channel, Message message, Utime utime, Utime release = kNever) {
    message.header = world_.next(channel, utime, release == kNever ? utime : release);
    bus_.publish(channel, &message);
  }

  void tick(Utime utime) {
    tick_t tick;
    tick.header = world_.next(channel::kTick, utime, utime);
    tick.mode = tick_t::LOCKSTEP;
    tick.members = {node_.options().name};
    tick.member_count = 1;
    tick.streams = world_.take_updated();
    tick.stream_count = static_cast<std::int32_t>(tick.streams.size());
    bus_.publish(channel::kTick, &tick);
    while (bus_.handleTimeout(0) > 0) node_.handle(0);
  }

  // Malformed inputs of the channel, from the newest heartbeat.
  std::int64_t malformed(const std::string& channel) const {
    if (heartbeats_.empty()) return -1;
    for (const input_health_t& input : heartbeats_.back().inputs)
      if (input.channel == channel) return input.malformed;
    return -1;
  }

 private:
  lcm::LCM bus_;
  StreamCounter world_;
  Node node_;
  std::vector<heartbeat_t> heartbeats_;
};

}  // namespace rover::test
