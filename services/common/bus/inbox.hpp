// A node's received messages: decoded, checked for damage, loss and order, and held until their release time.
#pragma once

#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <map>
#include <memory>
#include <rover/header_t.hpp>
#include <rover/injection_t.hpp>
#include <rover/input_health_t.hpp>
#include <string>
#include <vector>

#include "common/bus/channel_types.hpp"
#include "common/bus/fault_injector.hpp"
#include "common/bus/streams.hpp"
#include "common/core/time.hpp"

namespace rover {

// An undecoded message.
struct RawMessage {
  std::string channel;
  header_t header{};
  std::vector<std::uint8_t> bytes;
};

// Writes one line to the service's log.
using EventLog = std::function<void(const char* level, const std::string& event)>;

class Inbox {
 public:
  // Calls the handler with a decoded message.
  using Deliver = std::function<void()>;
  // Empty if the bytes are not a message of the type.
  using Decode = std::function<Deliver(RawMessage)>;
  struct Subscription;
  // A message that waits for its release.
  struct Pending {
    Utime release = 0;
    Utime slow = 0;  // of its subscription
    Subscription* subscription = nullptr;
    std::string channel;
    header_t header{};
    Deliver deliver;                  // empty: damaged by the fault injector
    std::vector<std::uint8_t> bytes;  // for the fault injector; empty if not needed
  };

  // injector: null without injection and muted channels. The bus outlives the inbox.
  Inbox(lcm::LCM& lcm, std::unique_ptr<FaultInjector> injector, bool allow_injection, EventLog log);
  ~Inbox();
  Inbox(const Inbox&) = delete;
  Inbox& operator=(const Inbox&) = delete;

  // slow: the node publishes nothing for this long after it began to process such a message. types: of a subscription
  // to all channels (".*"), which checks each by its own type; null: checked by the fingerprint.
  void add(const std::string& channel, std::int64_t fingerprint, Utime slow, Decode decode,
           FindChannelType types = nullptr);
  // True if the fault applies to received messages.
  bool inject(const injection_t& injection) { return injector_->inject(injection); }

  // Whether the stream is subscribed and messages up to its seq are missing.
  bool misses(const stream_seq_t& stream) const;
  bool knows(const stream_seq_t& stream) const { return ledger_.known(stream); }
  void give_up(const stream_seq_t& stream) { ledger_.give_up(stream); }

  // Removes the messages released until then, in the order (release, channel, publisher, boot, seq).
  std::vector<Pending> take_released(Utime until);
  // Calls its handler, unless it is out of order.
  void dispatch(const Pending& pending);
  // Instead of dispatch: the message is not needed, and not missing.
  void leave_out(const Pending& pending);
  // A restarted process drops messages from before its first tick, because which of them it received depends on how
  // fast it started.
  void forget_before(Utime first_tick);

  void count_malformed(input_health_t& health, const std::string& channel, const std::string& why);
  // The content of a message was not usable: counts as malformed.
  void reject(const std::string& channel, const std::string& why);
  // Null if the channel is not subscribed.
  const input_health_t* health(const std::string& channel) const;
  std::vector<input_health_t> health() const;

 private:
  void receive(const lcm::ReceiveBuffer* buffer, const std::string& channel, Subscription& subscription);
  void enqueue(Subscription& subscription, Pending pending, Utime delay);
  std::vector<Pending> apply_injections(std::vector<Pending> released);
  void inject_faults(Pending pending, std::vector<Pending>& passed);
  static bool in_order(Subscription& subscription, const std::string& channel, const header_t& header);

  lcm::LCM& lcm_;
  std::unique_ptr<FaultInjector> injector_;
  bool allow_injection_;
  EventLog log_;
  ArrivalLedger ledger_;
  std::vector<std::unique_ptr<Subscription>> subscriptions_;
  std::map<std::pair<std::string, std::string>, std::int64_t> malformed_;  // by subscription and channel
  std::vector<Pending> pending_;
};

// Nothing received on the channel yet.
input_health_t no_input_yet(const std::string& channel);

}  // namespace rover
