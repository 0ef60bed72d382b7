// Keeps two rovers off one bus, where they would drive each other. The locks are seen wherever the bus is: by all users
// and containers of a network.
#pragma once

#include <string>

namespace rover {

// Locks the bus for this process.
class BusLock {
 public:
  explicit BusLock(const std::string& bus_url);
  ~BusLock();
  BusLock(const BusLock&) = delete;
  BusLock& operator=(const BusLock&) = delete;
  bool held() const { return socket_ >= 0; }

 private:
  int socket_ = -1;
};

// A free bus for one drive of a campaign or bench, different from those of all others.
class BusSlot {
 public:
  // Throws ConfigError if all are taken.
  BusSlot();
  ~BusSlot();
  BusSlot(const BusSlot&) = delete;
  BusSlot& operator=(const BusSlot&) = delete;
  std::string url() const;

 private:
  int socket_ = -1;
  int slot_ = 0;
};

}  // namespace rover
