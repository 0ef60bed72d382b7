// Between the threads of the service: the operator's commands on their way to the bus and their answers, and the
// logbook.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>

#include "mission_control/logbook.hpp"

namespace rover::mission {

// What became of a command.
struct Answer {
  enum class Outcome { kAccepted, kRefused, kSilence, kNoTime, kBusy };  // kNoTime: the rover's clock stands still
  Outcome outcome = Outcome::kSilence;
  std::int64_t command_id = -1;
  std::string reason;
};

// Commands wait here until the node, which alone speaks on the bus, takes them.
class Desk {
 public:
  struct Waiting {
    std::int64_t ticket;
    Command command;
  };

  // Blocks until it is answered, at most so long. A command that was not given by then is withdrawn, so that it does
  // not move the rover when nobody expects it any more; one that stops the rover stays.
  Answer give(const Command& command, std::chrono::milliseconds patience);

  // The node's side.
  std::optional<Waiting> take();
  void given(std::int64_t ticket, std::int64_t command_id);
  // The command that the answer belongs to, where it came from here.
  std::optional<Command> answered(std::int64_t command_id, bool accepted, const std::string& reason);

 private:
  struct Entry {
    Command command;
    bool taken = false;
    bool abandoned = false;  // nobody waits for its answer any more
    std::int64_t command_id = -1;
    std::optional<Answer> answer;
  };
  Answer outcome_of(std::int64_t ticket);

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

struct Station {
  Desk desk;
  SharedLogbook book;
  std::atomic<double> now_s = 0.0;          // message time of the newest tick
  std::atomic<bool> page_is_served = true;  // false: the page's address is not to be had
};

}  // namespace rover::mission
