#include "supervisor/service_keeper.hpp"

#include <algorithm>

namespace rover::supervisor {

std::vector<std::string> ServiceKeeper::step(Utime now, const std::vector<std::string>& ailing) {
  std::vector<std::string> orders;
  for (const std::string& service : ailing) {
    std::deque<Utime>& tries = tries_[service];
    if (!tries.empty() && now - tries.back() < to_utime(config_.patience_s)) continue;
    if (std::find(orders.begin(), orders.end(), service) != orders.end()) continue;
    tries.push_back(now);
    orders.push_back(service);
  }
  return orders;
}

std::map<std::string, int> ServiceKeeper::tries(Utime now) const {
  std::map<std::string, int> out;
  for (const auto& [service, tries] : tries_)
    out[service] = static_cast<int>(
        std::count_if(tries.begin(), tries.end(), [&](Utime at) { return now - at <= to_utime(config_.window_s); }));
  return out;
}

}  // namespace rover::supervisor
