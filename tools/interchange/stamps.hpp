// The times of pictures, checked before anything is made of them.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace rover::interchange {

class Stamps {
 public:
  // In nanoseconds. `fail` is called, and does not return, where it does not rise or is more than a minute after the
  // one before: every second of a log costs space, with pictures or without.
  void add(std::int64_t time_ns, const std::function<void(const std::string&)>& fail);
  // The median from one to the next; throws ConfigError where no camera is so fast or slow: times in other units.
  std::int64_t interval_ns(const std::string& file) const;
  const std::vector<std::int64_t>& all_ns() const { return times_ns_; }

 private:
  std::vector<std::int64_t> times_ns_;
};

}  // namespace rover::interchange
