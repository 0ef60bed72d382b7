// Subscribes to telemetry for the page while a page is open. It shares the node's bus and thread, because a second
// socket would wake the process twice per datagram. Only this class subscribes to TRUTH; the node never sees it.
#pragma once

#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <list>
#include <mutex>
#include <string>

#include "mission_control/page_clients.hpp"
#include "mission_control/telemetry_store.hpp"

namespace rover::mission {

class TelemetrySubscriber {
 public:
  // The bus must outlive this object.
  TelemetrySubscriber(lcm::LCM& bus, PageClients& clients, const std::vector<std::string>& services);
  ~TelemetrySubscriber();
  TelemetrySubscriber(const TelemetrySubscriber&) = delete;
  TelemetrySubscriber& operator=(const TelemetrySubscriber&) = delete;

  // Subscribes and unsubscribes as pages come and go. Call every tick in the bus thread. `wall_s`: steady clock.
  void update(double wall_s);
  bool subscribed() const { return !subscriptions_.empty(); }

  // Thread-safe access to the store.
  template <class Use>
  auto with(Use use) {
    const std::lock_guard lock(mutex_);
    return use(store_);
  }

 private:
  using Handler = std::function<void(const lcm::ReceiveBuffer*)>;
  struct Subscription {
    lcm::Subscription* handle;
    Handler handler;
  };

  template <class Message, class Callback>
  Subscription* subscribe(const char* channel, Callback callback);
  template <class Message>
  Subscription* subscribe(const char* channel);
  void subscribe_all();
  void unsubscribe_all();
  void unsubscribe(Subscription*& subscription);

  lcm::LCM& bus_;
  PageClients& clients_;
  std::mutex mutex_;
  TelemetryStore store_;
  std::list<Subscription> subscriptions_;
  Subscription* disparity_ = nullptr;
  Subscription* truth_ = nullptr;
  double page_seen_s_ = 0.0;
};

// Seconds of a steady clock.
double wall_seconds();

}  // namespace rover::mission
