// Waits for the phase, injects a cause, ends it, waits until the stack has recovered; repeats.
#pragma once

#include <optional>
#include <random>
#include <vector>

#include "test/bench_faults/cases.hpp"
#include "test/bench_faults/log.hpp"

namespace rover::bench_faults {

class Injector {
 public:
  // Each row at least `per_row` times, spread over its phases, motors and services; at most `most` in total.
  // `rocks_at_m`: ahead of the body origin, so near that the rover stops before it finds a way around.
  Injector(const std::vector<Case>& cases, int per_row, size_t most, double rocks_at_m, const Observer& seen,
           Hands& hands, Field& field, Log& log, std::uint64_t seed);

  void step(Utime now);
  // A cause is active: the operator does not intervene.
  bool injecting() const { return active_ && !ended_; }
  bool done() const { return next_ >= plan_.size() && !active_; }
  // The stack does not recover.
  bool lost() const;
  size_t count() const { return next_; }
  // Injections after which the stack did not recover, by itself or by the usual commands.
  int stuck() const { return stuck_; }

 private:
  struct Planned {
    const Case* what;
    const Cause* cause;
    Phase phase;
    std::string who;
    int turn;
    std::string row() const { return who.empty() ? what->row : what->row + "." + who; }
  };
  void plan(int per_row, size_t most);
  void seek(const Planned& wanted);
  void leave();
  bool is_time_for(const Planned& wanted) const;
  void begin(const Planned& planned);
  void watch();
  void end();
  bool well() const;

  const std::vector<Case>& cases_;
  double rocks_at_m_;
  const Observer& seen_;
  Hands& hands_;
  Field& field_;
  Log& log_;
  std::mt19937_64 random_;
  std::vector<Planned> plan_;
  size_t next_ = 0;
  std::optional<Planned> active_;
  bool ended_ = false;  // the cause of the active injection has ended
  Utime begun_at_ = 0;
  Utime ended_at_ = 0;
  Utime seeking_since_ = 0;
  Utime well_at_ = 0;
  int stuck_ = 0;
};

}  // namespace rover::bench_faults
