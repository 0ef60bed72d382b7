// Barrier of the lockstep simulation (conservative discrete events): which participants allow the next tick.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/core/time.hpp"

namespace rover {

class Barrier {
 public:
  explicit Barrier(const std::vector<std::string>& participants);

  // A process of the participant waits for its first tick. Ignored for unknown names and for boots that are not newer.
  // If its predecessor still takes part, it becomes ready when the predecessor leaves.
  void ready(const std::string& name, std::int64_t boot_id, int pid);
  // The participant has done the tick and publishes nothing with a release before `promise`. Busy: it has only begun
  // long work and reports the tick again when done.
  void done(const std::string& name, std::int64_t boot_id, int pid, Utime tick, Utime promise, bool busy = false);

  // Participants that TICK(t) has to wait for.
  std::vector<std::string> waiting_for(Utime t) const;
  // Members of TICK(t), which is issued next. New processes join here, at a message time that does not depend on how
  // fast they started.
  std::vector<std::string> admit(Utime t);

  // The participant leaves at `now` and takes part again from now + return_after on. The ticks wait for its process
  // from half of that time on, so that it receives all inputs of its first tick. After kDied only a newer process
  // returns, after kSilent also the same one.
  enum class Cause { kDied, kSilent };
  void leave(const std::string& name, Cause cause, Utime now, Utime return_after);
  // Ticks no longer wait for the absent participant. It returns when it reports.
  void give_up(const std::string& name);
  // The idle participant is not needed; a newer process returns, not before expect().
  void stop(const std::string& name);
  // The ticks wait for the stopped participant as after leave().
  void expect(const std::string& name, Utime now, Utime return_after);
  // Whether it is a member of the ticks.
  bool takes_part(const std::string& name) const;
  // Whether it has finished the last tick.
  bool idle(const std::string& name) const;
  // Idle participants allow ticks up to t, for a jump of message time.
  void allow_until(Utime t);
  // Process of the participant; 0 if unknown.
  int pid_of(const std::string& name) const;
  const std::vector<std::string>& participants() const { return names_; }

 private:
  enum class State { kAbsent, kReady, kWorking };
  static constexpr Utime kNotExpected = std::numeric_limits<Utime>::max();
  struct Process {
    std::int64_t boot_id = 0;
    int pid = 0;
  };
  struct Member {
    State state = State::kAbsent;
    std::int64_t boot_id = 0;
    int pid = 0;
    std::optional<Process> successor;  // reported while this process still takes part
    bool may_wake = false;             // absent because of a timeout
    bool awaited = true;               // while absent
    Utime finished = kNever;           // last completed tick
    Utime clear_until = kNever;        // TICK(t) may be issued up to this time
    Utime up_from = kNever;            // while absent: ticks from this time on wait for its process
    Utime expected_from = kNever;      // from this time on it takes part
  };
  std::vector<std::string> names_;
  std::map<std::string, Member> members_;
  Utime last_given_ = kNever;
};

}  // namespace rover
