// Selects services to kill so that they restart. The fault row restart_failed limits the attempts.
#pragma once

#include <deque>
#include <map>
#include <string>
#include <vector>

#include "common/core/time.hpp"

namespace rover::supervisor {

struct ServiceRestarterConfig {
  double retry_interval_s = 5.0;  // waiting time before the next attempt
  double window_s = 60.0;
};

class ServiceRestarter {
 public:
  using Attempts = std::map<std::string, std::deque<Utime>>;

  explicit ServiceRestarter(const ServiceRestarterConfig& config) : config_(config) {}

  // Returns the services to kill now, out of those with an active restart_service fault.
  std::vector<std::string> step(Utime now, const std::vector<std::string>& services_to_restart);
  // Attempts within the window.
  std::map<std::string, int> restart_attempts(Utime now) const;
  void reset() { restart_attempts_.clear(); }
  const Attempts& attempts() const { return restart_attempts_; }
  void restore(Attempts attempts) { restart_attempts_ = std::move(attempts); }

 private:
  ServiceRestarterConfig config_;
  Attempts restart_attempts_;
};

}  // namespace rover::supervisor
