// Commands of one channel on their way to the motors: by release, through the tap where there is one.
#pragma once

#include <cstdint>
#include <optional>
#include <rover/ptu_command_t.hpp>
#include <rover/wheel_command_t.hpp>
#include <vector>

#include "common/bus/tap.hpp"

namespace rover {

template <class Command>
class CommandInbox {
 public:
  explicit CommandInbox(const char* channel) : channel_(channel) {}

  void add(const Command& command) { waiting_.push_back({command.header.release_utime, command, false}); }
  // The newest of those released until t; none where nothing new came. Older ones that come later are void.
  std::optional<Command> take(Utime t, Tap* tap);

 private:
  struct Waiting {
    Utime release;
    Command command;
    bool tapped;
  };
  std::vector<Waiting> take_released(Utime t);
  void pass(const Command& command, Tap& tap, std::vector<Waiting>& passed);

  const char* channel_;
  std::vector<Waiting> waiting_;
  std::int64_t boot_id_ = 0;
  std::int64_t seq_ = 0;
};

extern template class CommandInbox<wheel_command_t>;
extern template class CommandInbox<ptu_command_t>;

}  // namespace rover
