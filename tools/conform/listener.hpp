// Hears a driver on the bus.
#pragma once

#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <rover/image_t.hpp>
#include <rover/imu_t.hpp>
#include <rover/tick_t.hpp>
#include <rover/wheel_state_t.hpp>
#include <string>
#include <vector>

#include "tools/conform/heard.hpp"

namespace rover::conform {

class Listener {
 public:
  // `clock`: this machine's time [s]. The bus outlives the listener.
  Listener(lcm::LCM& lcm, std::function<double()> clock);
  ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  // Newest TICK, kNever before the first.
  Utime now() const { return now_; }
  const Heard& heard() const { return heard_; }
  // What was heard since the last call; begins anew.
  Heard take();

 private:
  template <class Message>
  void listen(const char* channel);
  void hear(const tick_t& message, const Stamp& stamp, const std::string& channel);
  void hear(const imu_t& message, const Stamp& stamp, const std::string& channel);
  void hear(const wheel_state_t& message, const Stamp& stamp, const std::string& channel);
  void hear(const image_t& message, const Stamp& stamp, const std::string& channel);

  lcm::LCM& lcm_;
  std::function<double()> clock_;
  std::vector<lcm::Subscription*> taken_;
  Utime now_ = kNever;
  Heard heard_;
};

}  // namespace rover::conform
