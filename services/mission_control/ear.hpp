// Listens to the bus for the page, beside the node and only while a page is open: it subscribes when one opens, in the
// node's thread and on the node's own bus, so that no datagram wakes anybody twice. It publishes nothing and takes no
// part in the lockstep. It alone takes TRUTH, and that only while a page asks to see it; nothing of it reaches the node
// that gives commands.
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
  // The bus outlives the ear.
  Ear(lcm::LCM& bus, Audience& audience, const std::vector<std::string>& services);
  ~Ear();
  Ear(const Ear&) = delete;
  Ear& operator=(const Ear&) = delete;

  // To be called often, in the thread that handles the bus: begins and ends to listen. `wall_s`: a steady clock.
  void attend(double wall_s);
  bool listening() const { return !handlers_.empty(); }

  // From any thread.
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
