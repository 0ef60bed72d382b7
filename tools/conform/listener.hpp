// Receives a driver's messages from the bus.
#pragma once

#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <rover/image_t.hpp>
#include <rover/imu_t.hpp>
#include <rover/tick_t.hpp>
#include <rover/wheel_state_t.hpp>
#include <string>
#include <vector>

#include "tools/conform/received.hpp"

namespace rover::conform {

class Listener {
 public:
  // `clock`: wall time [s]. The bus must outlive the listener.
  Listener(lcm::LCM& lcm, std::function<double()> clock);
  ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  // Newest TICK, kNever before the first.
  Utime now() const { return now_; }
  const Received& received() const { return received_; }
  // The messages received since the last call.
  Received take();

 private:
  template <class Message>
  void listen(const char* channel);
  void receive(const tick_t& message, const Stamp& stamp, const std::string& channel);
  void receive(const imu_t& message, const Stamp& stamp, const std::string& channel);
  void receive(const wheel_state_t& message, const Stamp& stamp, const std::string& channel);
  void receive(const image_t& message, const Stamp& stamp, const std::string& channel);

  lcm::LCM& lcm_;
  std::function<double()> clock_;
  std::vector<lcm::Subscription*> subscriptions_;
  Utime now_ = kNever;
  Received received_;
};

}  // namespace rover::conform
