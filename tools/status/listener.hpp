// Takes every message of the bus into an account. It publishes nothing and takes no part in the lockstep.
#pragma once

#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <rover/header_t.hpp>

#include "tools/status/account.hpp"

namespace rover::status {

class Listener {
 public:
  // `wall_s`: a steady clock in seconds.
  Listener(lcm::LCM& lcm, Account& account, std::function<double()> wall_s);
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  // Until the clock says so, or `going` no longer holds. False where the bus has failed.
  bool listen_until(double wall_s, const std::function<bool()>& going);

 private:
  void receive(const std::string& channel, const void* data, int size);
  bool take(const std::string& channel, const header_t& header, const void* data, int size);

  lcm::LCM& lcm_;
  Account& account_;
  std::function<double()> wall_s_;
};

}  // namespace rover::status
