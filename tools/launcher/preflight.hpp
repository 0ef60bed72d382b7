// Checks of the machine before services start. Each failure names the command that fixes it.
#pragma once

#include <string>
#include <vector>

#include "tools/launcher/bus_lock.hpp"

namespace rover {

// Problems of the bus, one line each.
std::vector<std::string> bus_problems(const std::string& bus_url);

// Throws ConfigError if a service is not built.
void require_programs(const std::vector<std::string>& services, const std::string& bin_dir);

// Throws ConfigError, one line per problem, if the bus is unusable or locked by another rover.
void require_usable_bus(const std::string& bus_url, const BusLock& lock);

// One line with the page's address; empty without a page. A used port disables the page, not the run.
std::string page_line(const std::string& config_dir);

}  // namespace rover
