// Subscribes to telemetry for the page while a page is open. It shares the node's bus and thread, because a second
// socket would wake the process twice per datagram. Only this class subscribes to TRUTH; the node never sees it.
#pragma once

#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <list>
#include <mutex>
#include <string>

#include "mission_control/audience.hpp"
#include "mission_control/gatherer.hpp"

namespace rover::mission {

class Ear {
 public:
  // The bus must outlive this object.
  Ear(lcm::LCM& bus, Audience& audience, const std::vector<std::string>& services);
  ~Ear();
  Ear(const Ear&) = delete;
  Ear& operator=(const Ear&) = delete;

  // Subscribes and unsubscribes as pages come and go. Call every tick in the bus thread. `wall_s`: steady clock.
  void attend(double wall_s);
  bool listening() const { return !handlers_.empty(); }

  // Thread-safe access to the store.
  template <class Use>
  auto with(Use use) {
    const std::lock_guard lock(mutex_);
    return use(gatherer_);
  }

 private:
  using Handler = std::function<void(const lcm::ReceiveBuffer*)>;
  struct Hearing {
    lcm::Subscription* subscription;
    Handler handler;
  };

  template <class Message, class Take>
  Hearing* hear(const char* channel, Take take);
  template <class Message>
  Hearing* hear(const char* channel);
  void begin();
  void end();
  void drop(Hearing*& hearing);

  lcm::LCM& bus_;
  Audience& audience_;
  std::mutex mutex_;
  Gatherer gatherer_;
  std::list<Hearing> handlers_;
  Hearing* disparity_ = nullptr;
  Hearing* truth_ = nullptr;
  double page_seen_s_ = 0.0;
};

// Seconds of a steady clock.
double wall_seconds();

}  // namespace rover::mission
