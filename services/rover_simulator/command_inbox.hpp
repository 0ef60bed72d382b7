// Queue of actuator commands from one channel, ordered by release time, with optional fault injection (FaultInjector).
#pragma once

#include <cstdint>
#include <optional>
#include <rover/ptu_command_t.hpp>
#include <rover/wheel_command_t.hpp>
#include <vector>

#include "common/bus/fault_injector.hpp"

namespace rover {

template <class Command>
class CommandInbox {
 public:
  explicit CommandInbox(const char* channel) : channel_(channel) {}

  void add(const Command& command) { pending_.push_back({command.header.release_utime, command, false}); }
  // The newest command released by t; empty without a new one. Older commands that arrive later are dropped.
  std::optional<Command> take(Utime t, FaultInjector* injector);

 private:
  struct Pending {
    Utime release;
    Command command;
    bool fault_injected;
  };
  std::vector<Pending> take_released(Utime t);
  void inject_faults(const Command& command, FaultInjector& injector, std::vector<Pending>& ready);

  const char* channel_;
  std::vector<Pending> pending_;
  std::int64_t boot_id_ = 0;
  std::int64_t seq_ = 0;
};

extern template class CommandInbox<wheel_command_t>;
extern template class CommandInbox<ptu_command_t>;

}  // namespace rover
