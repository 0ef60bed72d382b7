// The last guard before the motors: which WHEEL_COMMAND counts, and until when.
#pragma once

#include <optional>
#include <rover/wheel_command_t.hpp>
#include <vector>

#include "common/core/time.hpp"

namespace example {

using rover::Utime;

class WheelWatchdog {
 public:
  void take(const rover::wheel_command_t& command) { waiting_.push_back(command); }
  // The command to obey at t; none: wheels at rest, steering as it is.
  std::optional<rover::wheel_command_t> in_force(Utime t);
  // Whether the newest command has run out: WHEEL_STATE says so.
  bool expired(Utime t) const { return newest_ && newest_->valid_until_utime < t; }

 private:
  std::vector<rover::wheel_command_t> waiting_;  // not released yet
  std::optional<rover::wheel_command_t> newest_;
};

}  // namespace example
