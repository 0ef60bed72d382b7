// Which services are to be killed so that they start anew: bounded tries, then the rover gives up (row restart_failed).
#pragma once

#include <deque>
#include <map>
#include <string>
#include <vector>

#include "common/core/time.hpp"

namespace rover::supervisor {

struct ServiceKeeperConfig {
  double patience_s = 5.0;  // for a service to come back, before the next try
  double window_s = 60.0;
};

class ServiceKeeper {
 public:
  explicit ServiceKeeper(const ServiceKeeperConfig& config) : config_(config) {}

  // `ailing`: services that a standing row wants to be started anew. Those to be killed now.
  std::vector<std::string> step(Utime now, const std::vector<std::string>& ailing);
  // Tries within the window.
  std::map<std::string, int> tries(Utime now) const;
  void forget() { tries_.clear(); }

 private:
  ServiceKeeperConfig config_;
  std::map<std::string, std::deque<Utime>> tries_;
};

}  // namespace rover::supervisor
