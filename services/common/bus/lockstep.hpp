// A node's side of the clock: which tick may be processed, and the reports (DONE) for which the clock master waits.
#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <optional>
#include <rover/done_t.hpp>
#include <rover/input_health_t.hpp>
#include <rover/tick_t.hpp>
#include <string>
#include <vector>

#include "common/bus/inbox.hpp"
#include "common/bus/streams.hpp"
#include "common/core/time.hpp"

namespace rover {

class Lockstep {
 public:
  using Report = std::function<void(const done_t&)>;

  // The bus and the inbox outlive it.
  Lockstep(const std::string& name, std::int64_t boot_id, lcm::LCM& lcm, Inbox& inbox, Report report, EventLog log);
  ~Lockstep();
  Lockstep(const Lockstep&) = delete;
  Lockstep& operator=(const Lockstep&) = delete;

  // The next tick, once all messages that it lists are in the inbox. A node that is late by the clock gets the newest.
  std::optional<tick_t> next();
  // The tick is done, or begun (busy). The node publishes nothing with a release before `promise`.
  void done(Utime tick, Utime promise, std::vector<stream_seq_t> updated, bool busy);
  // Tells the clock master that this node waits for ticks.
  void announce() const;

  // True if the newest ticks were paced by the clock, not by lockstep.
  bool follows_clock() const { return last_tick_wall_.has_value(); }
  // True once if clock-paced ticks are missing for 0.3 s of wall time.
  bool ticks_timed_out();
  const input_health_t& health() const { return health_; }

 private:
  using Clock = std::chrono::steady_clock;
  struct QueuedTick {
    tick_t tick{};
    Clock::time_point arrived;
  };
  void receive(const lcm::ReceiveBuffer* buffer, const std::string& channel);
  bool holds_all_for(const QueuedTick& queued);

  std::string name_;
  lcm::LCM& lcm_;
  Inbox& inbox_;
  Report report_;
  EventLog log_;
  StreamCounter reports_;  // DONE does not list itself
  lcm::Subscription* ticks_on_bus_;
  input_health_t health_;
  std::deque<QueuedTick> ticks_;
  std::optional<Clock::time_point> last_tick_wall_;  // of clock-paced ticks, until they time out
  done_t last_done_{};
  Utime now_ = kNever;  // of the last tick returned by next()
};

}  // namespace rover
