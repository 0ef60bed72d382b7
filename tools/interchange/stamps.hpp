// Checks image timestamps.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace rover::interchange {

class Stamps {
 public:
  // Time [ns]. Calls `fail` (which must not return) if it does not increase, or is over 60 s after the previous one.
  void add(std::int64_t time_ns, const std::function<void(const std::string&)>& fail);
  // Median interval; throws ConfigError if no camera has such a rate (wrong time unit).
  std::int64_t interval_ns(const std::string& file) const;
  const std::vector<std::int64_t>& all_ns() const { return times_ns_; }

 private:
  std::vector<std::int64_t> times_ns_;
};

}  // namespace rover::interchange
