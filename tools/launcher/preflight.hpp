// What must be so on this machine before services start; each failure names the command that mends it.
#pragma once

#include <string>
#include <vector>

namespace rover {

// Lines that say what is wrong with the bus; empty where all is well.
std::vector<std::string> bus_problems(const std::string& bus_url);

// Holds the bus for this process: two rovers on one bus would drive each other. Released when the process ends.
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

// Throws ConfigError where one of the services is not built.
void demand_programs(const std::vector<std::string>& services, const std::string& bin_dir);

// Throws ConfigError, with one line for each problem, where the bus cannot be used or is another rover's.
void demand_bus(const std::string& bus_url, const BusLock& lock);

// Where the run's page will be, as one line for the user; empty where it has none. A taken port takes the page from a
// run, not the run.
std::string page_line(const std::string& config_dir);

}  // namespace rover
