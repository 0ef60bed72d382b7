// Passes every message of the bus to the statistics. Publishes nothing and takes no part in lockstep.
#pragma once

#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <rover/header_t.hpp>

#include "tools/status/bus_statistics.hpp"

namespace rover::status {

class Listener {
 public:
  // `wall_s`: a monotonic clock [s].
  Listener(lcm::LCM& lcm, BusStatistics& statistics, std::function<double()> wall_s);
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  // Handles messages until wall_s or until `running` is false. Returns false if the bus fails.
  bool listen_until(double wall_s, const std::function<bool()>& running);

 private:
  void receive(const std::string& channel, const void* data, int size);
  bool dispatch(const std::string& channel, const header_t& header, const void* data, int size);

  lcm::LCM& lcm_;
  BusStatistics& statistics_;
  std::function<double()> wall_s_;
};

}  // namespace rover::status
