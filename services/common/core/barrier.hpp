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
  // one that has died. One that is up before its predecessor was missed may have taken the predecessor's ticks, and
  // then reports those: it counts as up from when the predecessor leaves.
  void ready(const std::string& name, std::int64_t boot_id, int pid);
  // The participant has done the tick and publishes nothing that is released before `promise`. Busy: it has only begun
  // long work on the tick, and reports it again when that is done.
  void done(const std::string& name, std::int64_t boot_id, int pid, Utime tick, Utime promise, bool busy = false);

  // Those for whom TICK(t) has to wait.
  std::vector<std::string> waiting_for(Utime t) const;
  // Those who take part in TICK(t), which is about to be given: newcomers join here, at a message time that does not
  // depend on how fast their processes started.
  std::vector<std::string> admit(Utime t);

  // The participant leaves at `now` and takes part again from now + return_after on. Its process is waited for from
  // half of that time on, so that it hears all that concerns it when it takes part. A process that died returns as a
  // newer one only, one that was silent also by its next report.
  enum class Cause { kDied, kSilent };
  void leave(const std::string& name, Cause cause, Utime now, Utime return_after);
  // The participant is absent and nobody waits for it any more; it returns when it reports.
  void give_up(const std::string& name);
  // Whether it takes part in the ticks.
  bool takes_part(const std::string& name) const;
  // Whether it owes nothing for the last tick given: its process idles until the next.
  bool idle(const std::string& name) const;
  // The next tick may be as late as t for all who idle: message time jumps.
  void allow_until(Utime t);
  // Process of the participant, 0 where none is known.
  int pid_of(const std::string& name) const;
  const std::vector<std::string>& participants() const { return names_; }

 private:
  enum class State { kAbsent, kReady, kWorking };
  struct Process {
    std::int64_t boot_id = 0;
    int pid = 0;
  };
  struct Member {
    State state = State::kAbsent;
    std::int64_t boot_id = 0;
    int pid = 0;
    std::optional<Process> successor;  // reported while this one still counts as working
    bool may_wake = false;             // absent because it was silent
    bool awaited = true;               // while absent
    Utime finished = kNever;           // last tick of which all work is done
    Utime clear_until = kNever;        // TICK(t) may be given for t up to here
    Utime up_from = kNever;            // while absent: ticks from here on wait for its process
    Utime expected_from = kNever;      // and from here on it takes part
  };
  std::vector<std::string> names_;
  std::map<std::string, Member> members_;
  Utime last_given_ = kNever;
};

}  // namespace rover
