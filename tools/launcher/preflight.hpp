// Checks of the machine before services start. Each failure names the command that fixes it.
#pragma once

#include <string>
#include <vector>

namespace rover {

// Problems of the bus, one line each.
std::vector<std::string> bus_problems(const std::string& bus_url);

// Locks the bus for this process, because two rovers on one bus would drive each other.
class BusLock {
 public:
  explicit BusLock(const std::string& bus_url);
  ~BusLock();
  BusLock(const BusLock&) = delete;
  BusLock& operator=(const BusLock&) = delete;
  bool held() const { return fd_ >= 0; }

 private:
  int fd_ = -1;
};

// Throws ConfigError if a service is not built.
void require_programs(const std::vector<std::string>& services, const std::string& bin_dir);

// Throws ConfigError, one line per problem, if the bus is unusable or locked by another rover.
void require_usable_bus(const std::string& bus_url, const BusLock& lock);

// One line with the page's address; empty without a page. A used port disables the page, not the run.
std::string page_line(const std::string& config_dir);

}  // namespace rover
