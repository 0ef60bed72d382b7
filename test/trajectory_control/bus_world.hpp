// Test harness for one node on an in-process bus: sends messages and ticks, records what the node publishes.
#pragma once

#include <deque>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <rover/tick_t.hpp>
#include <string>
#include <vector>

#include "common/bus/channels.hpp"
#include "common/bus/node.hpp"
#include "common/bus/streams.hpp"

namespace rover::test {

class BusWorld {
 public:
  // Records all messages of a type on a channel from now on.
  template <class Message>
  std::shared_ptr<std::vector<Message>> listen(const std::string& channel) {
    auto kept = std::make_shared<std::vector<Message>>();
    bus.subscribeFunction(
        channel,
        +[](const lcm::ReceiveBuffer*, const std::string&, const Message* m, std::vector<Message>* out) {
          out->push_back(*m);
        },
        kept.get());
    return kept;
  }

  // Measured now, released for the next tick, with an own sequence counter per publisher.
  template <class Message>
  void send(const std::string& channel, Message message, const std::string& publisher = "world") {
    message.header = counter(publisher).next(channel, now, now + kTickUs);
    bus.publish(channel, &message);
  }

  void tick(Node& node) {
    now += kTickUs;
    tick_t tick{};
    tick.header = counter("world").next(channel::kTick, now, now);
    tick.mode = tick_t::LOCKSTEP;
    tick.members = {node.options().name};
    tick.member_count = 1;
    bus.publish(channel::kTick, &tick);
    while (bus.handleTimeout(0) > 0) node.handle(0);
    node.handle(0);
  }

  lcm::LCM bus{"memq://"};
  Utime now = 0;

 private:
  StreamCounter& counter(const std::string& publisher) {
    for (StreamCounter& c : counters_)
      if (c.publisher() == publisher) return c;
    return counters_.emplace_back(publisher, 1);
  }
  std::deque<StreamCounter> counters_;
};

}  // namespace rover::test
