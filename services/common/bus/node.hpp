// The base of every service on the bus: inputs in tick and release order, DONE and promises, accounting, heartbeat.
//
// A node works in message time only. At TICK(t) it takes, in the order (release, channel, publisher, seq), every input
// released until t, calls its handlers, then its step, and reports DONE(t). What it publishes is released one tick
// later or later. A node that takes long promises, before it starts, to publish nothing before t + L; the world runs on
// meanwhile. TICK lists what has been published, so a node knows that it holds all it must have before it goes on.
#pragma once

#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <rover/heartbeat_t.hpp>
#include <rover/injection_t.hpp>
#include <rover/tick_t.hpp>
#include <string>
#include <vector>

#include "common/bus/channels.hpp"
#include "common/bus/config.hpp"
#include "common/bus/health.hpp"
#include "common/bus/inbox.hpp"
#include "common/bus/lockstep.hpp"
#include "common/bus/streams.hpp"
#include "common/core/time.hpp"

namespace rover {

struct NodeOptions {
  std::string name;                // service name = publisher
  std::int64_t boot_id = 1;        // larger at each start of the process
  std::string run_dir;             // checkpoints are kept here; empty: none
  bool allow_injection = false;    // builds the tap and obeys INJECT
  std::vector<std::string> muted;  // channels not to take, whatever arrives on them
};

class Node {
 public:
  // `reports` carries DONE; null: the bus itself.
  // The bus outlives the node.
  Node(NodeOptions options, lcm::LCM& lcm, lcm::LCM* reports = nullptr);
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  // Calls handler(message) at the first tick that is not before its release.
  template <class Message>
  void subscribe(const std::string& channel, std::function<void(const Message&)> handler);

  // As subscribe, for work that takes long: before the handlers of a tick that holds such a message the node promises
  // silence until tick + latency, and all it publishes in that time is released then.
  template <class Message>
  void subscribe_slow(const std::string& channel, Utime latency, std::function<void(const Message&)> handler);

  // Every message of every channel but DONE, undecoded, in the same order (recorder). What is not of the type that
  // `types` gives for its channel is dropped like any malformed input. The table is handed in: it names TRUTH, which no
  // other service may. Injected faults do not touch these messages: the record says what was sent.
  void subscribe_raw(std::function<void(const RawMessage&)> handler, FindChannelType types);

  // Each injection that reaches this node, whatever its target; never called unless injection is allowed.
  void on_injection(std::function<void(const injection_t&)> handler) { on_injection_ = std::move(handler); }

  // Called once each tick, after the inputs.
  void on_step(std::function<void(Utime now)> step) { step_ = std::move(step); }

  // Dead man's switch: called when ticks that followed the clock have come no more for 0.3 s of wall time, once until
  // they come again. Message time stands still then; what the node says is of the last tick.
  void on_silence(std::function<void()> silence) { silence_ = std::move(silence); }

  // Fills the header and publishes. `utime`: what the data are of. Release: the next tick plus extra_latency, or later
  // by a promise.
  template <class Message>
  void publish(const std::string& channel, Message& message, Utime utime, Utime extra_latency = 0);

  // Time since the newest message taken on the channel was measured [s], infinity where none came yet.
  double age_s(const std::string& channel) const;
  // The content of a message was not usable (range, NaN, size): counts as malformed.
  void reject(const std::string& channel, const std::string& why) { inbox_.reject(channel, why); }

  // Health that the next heartbeats report (heartbeat_t constants).
  void set_status(std::int8_t status, std::string text);
  // One line on the service's log: "utime level service EVENT key=value".
  void log(const char* level, const std::string& event);

  Utime now() const { return now_; }
  // Whether the newest ticks were paced by the clock, not by lockstep.
  bool follows_clock() const { return lockstep_.follows_clock(); }
  const NodeOptions& options() const { return options_; }

  // Announces the node, then handles messages while `running`.
  void run(const std::function<bool()>& running);
  // Handles what waits on the bus, at most timeout_ms; false where the bus failed.
  bool handle(int timeout_ms);
  // Tells the world that this node is there and waits for ticks.
  void announce() { lockstep_.announce(); }

 private:
  void process(const tick_t& tick);
  void obey(const injection_t& injection);
  void publish_heartbeat();
  template <class Message>
  void send(lcm::LCM& lcm, const std::string& channel, const Message& message);
  void send_bytes(lcm::LCM& lcm, const std::string& channel, const std::vector<std::uint8_t>& bytes);

  NodeOptions options_;
  lcm::LCM& lcm_;
  lcm::LCM& reports_;
  StreamCounter streams_;
  Inbox inbox_;
  Lockstep lockstep_;
  StepTimer timer_;
  std::function<void(Utime)> step_;
  std::function<void()> silence_;
  std::function<void(const injection_t&)> on_injection_;
  Utime now_ = kNever;
  Utime promise_ = kNever;
  std::int8_t status_ = heartbeat_t::OK;
  std::string status_text_;
};

template <class Message>
void Node::subscribe(const std::string& channel, std::function<void(const Message&)> handler) {
  subscribe_slow<Message>(channel, 0, std::move(handler));
}

template <class Message>
void Node::subscribe_slow(const std::string& channel, Utime latency, std::function<void(const Message&)> handler) {
  const auto shared = std::make_shared<const std::function<void(const Message&)>>(std::move(handler));
  inbox_.add(channel, Message::getHash(), latency, [shared](const RawMessage& raw) -> Inbox::Deliver {
    const auto message = std::make_shared<Message>();
    if (!decode_message(raw.bytes.data(), static_cast<int>(raw.bytes.size()), *message)) return nullptr;
    return [shared, message] { (*shared)(*message); };
  });
}

template <class Message>
void Node::publish(const std::string& channel, Message& message, Utime utime, Utime extra_latency) {
  message.header = streams_.next(channel, utime, std::max(now_ + kTickUs + extra_latency, promise_));
  send(lcm_, channel, message);
}

template <class Message>
void Node::send(lcm::LCM& lcm, const std::string& channel, const Message& message) {
  std::vector<std::uint8_t> bytes = encoded(message);
  send_bytes(lcm, channel, bytes);
}

}  // namespace rover
