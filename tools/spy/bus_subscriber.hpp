// Subscribes to every channel of a bus, including DONE on its separate port. Publishes nothing.
#pragma once

#include <lcm/lcm-cpp.hpp>
#include <string>

#include "tools/spy/traffic.hpp"

namespace rover::spy {

class BusSubscriber {
 public:
  // Throws ConfigError if the bus cannot be joined.
  BusSubscriber(const std::string& bus_url, Traffic& traffic);
  BusSubscriber(const BusSubscriber&) = delete;
  BusSubscriber& operator=(const BusSubscriber&) = delete;

  // Handles all messages that arrive within the timeout. Throws ConfigError if the bus fails.
  void listen(int timeout_ms);

 private:
  void subscribe(lcm::LCM& lcm);

  std::string url_;
  lcm::LCM bus_;
  lcm::LCM reports_;
  Traffic& traffic_;
};

}  // namespace rover::spy
