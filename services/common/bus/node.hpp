// The base of every service on the bus: inputs in tick and release order, DONE and promises, accounting, heartbeat.
//
// A node works in message time only. At TICK(t) it processes, in the order (release, channel, publisher, seq), every
// input released until t, then its step, and reports DONE(t). Its outputs are released at the next tick or later. A
// slow node first promises to publish nothing before t + L, and the simulation continues meanwhile. TICK lists all
// published messages, so a node can wait until it has received them.
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
#include "common/core/check.hpp"
#include "common/core/time.hpp"

namespace rover {

struct NodeOptions {
  std::string name;                // service name = publisher
  std::int64_t boot_id = 1;        // larger at each start of the process
  std::string run_dir;             // folder of checkpoints; empty: none
  bool allow_injection = false;    // apply the faults of INJECT
  std::vector<std::string> muted;  // channels to ignore
  double cpu_scale = 1.0;          // multiplies the latencies of slow work
};

class Node {
 public:
  // `reports` carries DONE; null: the bus itself. The bus outlives the node.
  Node(NodeOptions options, lcm::LCM& lcm, lcm::LCM* reports = nullptr);
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  // Calls handler(message) at the first tick at or after its release.
  template <class Message>
  void subscribe(const std::string& channel, std::function<void(const Message&)> handler);

  // For slow work: outputs are released at tick + latency, which the node promises before the handlers begin. Until
  // then newer frames (utime) wait, and of these it takes the newest.
  template <class Message>
  void subscribe_slow(const std::string& channel, Utime latency, std::function<void(const Message&)> handler);

  // Every message of every channel except DONE, undecoded, in the same order (recorder). Messages of another type than
  // `types` gives for the channel are malformed. `types` is an argument because it contains TRUTH, which no other
  // service may name. Injected faults do not affect these messages: the log contains what was sent.
  void subscribe_raw(std::function<void(const RawMessage&)> handler, FindChannelType types);

  // Called for each injection on any target, if injection is allowed.
  void on_injection(std::function<void(const injection_t&)> handler) { on_injection_ = std::move(handler); }

  // Called once each tick, after the input handlers.
  void on_step(std::function<void(Utime now)> step) { step_ = std::move(step); }

  // Dead man's switch: called once if clock-paced ticks are missing for 0.3 s of wall time. Message time stays at the
  // last tick.
  void on_tick_timeout(std::function<void()> handler) { tick_timeout_ = std::move(handler); }

  // Fills the header and publishes. `utime`: measurement time. Release: the next tick plus extra_latency, or the end of
  // a promise if that is later.
  template <class Message>
  void publish(const std::string& channel, Message& message, Utime utime, Utime extra_latency = 0);

  // Age of the newest processed message of the channel [s]; infinity before the first.
  double age_s(const std::string& channel) const;
  // The content of a message was not usable (range, NaN, size): counts as malformed.
  void reject(const std::string& channel, const std::string& why) { inbox_.reject(channel, why); }

  // Status of the next heartbeats (heartbeat_t constants).
  void set_status(std::int8_t status, std::string text);
  // One line of the service's log: "utime level service EVENT key=value".
  void log(const char* level, const std::string& event);

  Utime now() const { return now_; }
  // Once in each such period of message time, also if ticks are missing.
  bool once_in(Utime period) const;
  // True if the newest ticks were paced by the clock, not by lockstep.
  bool follows_clock() const { return lockstep_.follows_clock(); }
  // For slow work that begins in a step instead of with a message, while the node is not busy.
  bool busy() const { return promise_ > now_; }
  void begin_slow(Utime latency) { promise_ = now_ + scaled(latency); }
  // On the modelled computer.
  Utime scaled(Utime latency) const;
  const NodeOptions& options() const { return options_; }

  // For other subscribers in the node's thread. The process is then woken by all messages.
  lcm::LCM& share_bus();
  // No subscription follows. On a bus of this UDP port, what the node does not take no longer wakes the process.
  void close_subscriptions(int port);
  // Announces the node, then handles messages while `running`.
  void run(const std::function<bool()>& running);
  // Handles waiting messages for at most timeout_ms; false if the bus failed.
  bool handle(int timeout_ms);
  // Tells the clock master that this node waits for ticks.
  void announce() { lockstep_.announce(); }

 private:
  void process(const tick_t& tick);
  bool begin_slow(const std::vector<Inbox::Pending>& released);
  void wait(Inbox::Pending pending);
  void apply_injection(const injection_t& injection);
  void publish_heartbeat();
  std::vector<input_health_t> inputs() const;
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
  std::function<void()> tick_timeout_;
  std::function<void(const injection_t&)> on_injection_;
  bool shares_bus_ = false;
  bool subscriptions_closed_ = false;
  Utime now_ = kNever;
  Utime before_ = kNever;  // the tick before
  Utime promise_ = kNever;
  Utime frame_ = kNever;                 // of the slow work, until the promise
  std::vector<Inbox::Pending> waiting_;  // of one newer frame
  std::int8_t status_ = heartbeat_t::OK;
  std::string status_text_;
};

template <class Message>
void Node::subscribe(const std::string& channel, std::function<void(const Message&)> handler) {
  subscribe_slow<Message>(channel, 0, std::move(handler));
}

template <class Message>
void Node::subscribe_slow(const std::string& channel, Utime latency, std::function<void(const Message&)> handler) {
  ROVER_CHECK(!subscriptions_closed_, channel);
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
