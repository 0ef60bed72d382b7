// Listens to the bus for the page, in a thread of its own and only while a page is open. It publishes nothing and takes
// no part in the lockstep, so a slow page never slows the rover. It alone takes TRUTH, and that only while a page asks
// to see it; nothing of it reaches the node that gives commands.
#pragma once

#include <atomic>
#include <mutex>
#include <string>
#include <thread>

#include "mission_control/audience.hpp"
#include "mission_control/gatherer.hpp"

namespace rover::mission {

class Ear {
 public:
  Ear(std::string bus_url, Audience& audience, const std::vector<std::string>& services);
  ~Ear();
  Ear(const Ear&) = delete;
  Ear& operator=(const Ear&) = delete;

  template <class Use>
  auto with(Use use) {
    const std::lock_guard lock(mutex_);
    return use(gatherer_);
  }

 private:
  void run();
  void listen();

  std::string bus_url_;
  Audience& audience_;
  std::mutex mutex_;
  Gatherer gatherer_;
  std::atomic<bool> running_ = true;
  std::thread thread_;
};

// Seconds of a steady clock.
double wall_seconds();

}  // namespace rover::mission
