// State shared by the HTTP and bus threads: the command queue and the logbook.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>

#include "mission_control/logbook.hpp"

namespace rover::mission {

// Outcome of an operator command.
struct CommandReply {
  enum class Outcome { kAccepted, kRefused, kNoReply, kClockStopped, kBusy };  // kClockStopped: no tick arrived
  Outcome outcome = Outcome::kNoReply;
  std::int64_t command_id = -1;
  std::string reason;
};

// Queue of operator commands. HTTP threads submit; the node publishes and acknowledges.
class CommandQueue {
 public:
  struct Pending {
    std::int64_t ticket;
    Command command;
  };

  // Blocks until the acknowledgement or the timeout. A command not sent by then is withdrawn, because a late one would
  // move the rover unexpectedly; a stop stays queued.
  CommandReply submit(const Command& command, std::chrono::milliseconds timeout);

  // Called by the node.
  std::optional<Pending> next();
  void set_command_id(std::int64_t ticket, std::int64_t command_id);
  // Returns the acknowledged command if it came from this queue.
  std::optional<Command> acknowledge(std::int64_t command_id, bool accepted, const std::string& reason);

 private:
  struct Entry {
    Command command;
    bool sent = false;
    bool caller_gone = false;  // the caller timed out
    std::int64_t command_id = -1;
    std::optional<CommandReply> answer;
  };
  void drop_late(CommandKind kind);
  CommandReply take_reply(std::int64_t ticket);

  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::int64_t, Entry> entries_;
  std::int64_t next_ticket_ = 1;
};

class SharedLogbook {
 public:
  template <class Use>
  auto with(Use use) {
    const std::lock_guard lock(mutex_);
    return use(book_);
  }

 private:
  std::mutex mutex_;
  Logbook book_;
};

struct SharedState {
  CommandQueue commands;
  SharedLogbook book;
  std::atomic<double> now_s = 0.0;          // message time of the newest tick
  std::atomic<bool> page_is_served = true;  // false: the page's address is in use
};

}  // namespace rover::mission
