// The barrier of lockstep simulation (conservative discrete events): who has published all that belongs before a tick.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/core/time.hpp"

namespace rover {

class Barrier {
 public:
  explicit Barrier(const std::vector<std::string>& participants);

  // A process of the participant is up and waits for its first tick. Ignored for others, and for boots not newer than
  // one that has died.
  void ready(const std::string& name, std::int64_t boot_id, int pid);
  // The participant has done the tick and publishes nothing that is released before `promise`.
  void done(const std::string& name, std::int64_t boot_id, int pid, Utime tick, Utime promise);

  // Those for whom TICK(t) has to wait.
  std::vector<std::string> waiting_for(Utime t) const;
  // Those who take part in TICK(t), which is about to be given: newcomers join here, at a message time that does not
  // depend on how fast their processes started.
  std::vector<std::string> admit(Utime t);

  // The participant leaves at `now`; it is waited for again from now + return_after on. A process that died returns as
  // a newer one only, one that was silent also by its next report.
  enum class Cause { kDied, kSilent };
  void leave(const std::string& name, Cause cause, Utime now, Utime return_after);
  // Process of the participant, 0 where none is known.
  int pid_of(const std::string& name) const;
  const std::vector<std::string>& participants() const { return names_; }

 private:
  enum class State { kAbsent, kReady, kWorking };
  struct Member {
    State state = State::kAbsent;
    std::int64_t boot_id = 0;
    int pid = 0;
    bool may_wake = false;         // absent because it was silent
    Utime clear_until = kNever;    // TICK(t) may be given for t up to here
    Utime expected_from = kNever;  // while absent: ticks from here on wait for it
  };
  std::vector<std::string> names_;
  std::map<std::string, Member> members_;
};

}  // namespace rover
