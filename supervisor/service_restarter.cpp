#include "supervisor/service_restarter.hpp"

#include <algorithm>

namespace rover::supervisor {

std::vector<std::string> ServiceRestarter::step(Utime now, const std::vector<std::string>& services_to_restart) {
  std::vector<std::string> to_kill;
  for (const std::string& service : services_to_restart) {
    std::deque<Utime>& restart_attempts = restart_attempts_[service];
    if (!restart_attempts.empty() && now - restart_attempts.back() < to_utime(config_.retry_interval_s)) continue;
    if (std::find(to_kill.begin(), to_kill.end(), service) != to_kill.end()) continue;
    while (!restart_attempts.empty() && now - restart_attempts.front() > to_utime(config_.window_s))
      restart_attempts.pop_front();
    restart_attempts.push_back(now);
    to_kill.push_back(service);
  }
  return to_kill;
}

std::map<std::string, int> ServiceRestarter::restart_attempts(Utime now) const {
  std::map<std::string, int> out;
  for (const auto& [service, restart_attempts] : restart_attempts_)
    out[service] = static_cast<int>(std::count_if(restart_attempts.begin(), restart_attempts.end(),
                                                  [&](Utime at) { return now - at <= to_utime(config_.window_s); }));
  return out;
}

}  // namespace rover::supervisor
