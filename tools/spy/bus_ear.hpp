// Hears every channel of a bus, the reports of lockstep on their own port included. It publishes nothing.
#pragma once

#include <lcm/lcm-cpp.hpp>
#include <string>

#include "tools/spy/traffic.hpp"

namespace rover::spy {

class BusEar {
 public:
  // Throws ConfigError where the bus cannot be joined.
  BusEar(const std::string& bus_url, Traffic& traffic);
  BusEar(const BusEar&) = delete;
  BusEar& operator=(const BusEar&) = delete;

  // Waits for messages, at most so long, and takes all that have come. Throws ConfigError where the bus has failed.
  void listen(int timeout_ms);

 private:
  void subscribe(lcm::LCM& lcm);

  std::string url_;
  lcm::LCM bus_;
  lcm::LCM reports_;
  Traffic& traffic_;
};

}  // namespace rover::spy
