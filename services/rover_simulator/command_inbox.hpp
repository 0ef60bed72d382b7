// WHEEL_COMMAND on its way to the motors: by release, through the tap where there is one.
#pragma once

#include <optional>
#include <rover/wheel_command_t.hpp>
#include <vector>

#include "common/bus/tap.hpp"

namespace rover {

class CommandInbox {
 public:
  void add(const wheel_command_t& command) { waiting_.push_back({command.header.release_utime, command, false}); }
  // The newest of those released until t; none where nothing new came. Older ones that come later are void.
  std::optional<wheel_command_t> take(Utime t, Tap* tap);

 private:
  struct Waiting {
    Utime release;
    wheel_command_t command;
    bool tapped;
  };
  std::vector<Waiting> take_released(Utime t);
  void pass(const wheel_command_t& command, Tap& tap, std::vector<Waiting>& passed);

  std::vector<Waiting> waiting_;
  std::int64_t boot_id_ = 0;
  std::int64_t seq_ = 0;
};

}  // namespace rover
