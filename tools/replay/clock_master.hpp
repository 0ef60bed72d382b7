// Clock master of a replay: publishes TICK and collects DONE of the live services, as the simulator does.
#pragma once

#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <map>
#include <rover/done_t.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/bus/streams.hpp"
#include "common/core/barrier.hpp"

namespace rover::replay {

// A live service died, hangs or did not start; the replay cannot continue.
class ServiceGone : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class ClockMaster {
 public:
  using Running = std::function<bool()>;
  // `reports`: the bus that carries DONE.
  ClockMaster(const std::vector<std::string>& services, lcm::LCM& bus, lcm::LCM& reports);

  // Waits until every service is ready.
  void wait_for_start(const Running& running);
  // Registers a published message; the next tick lists it.
  void list(const std::string& channel, const header_t& header);
  // Publishes TICK(t) after all services have published what precedes it.
  // The service gets no more ticks; it is idle.
  void stop(const std::string& service) { barrier_.stop(service); }
  void publish_tick(Utime t, const Running& running);
  // Waits until all services have finished the work of the last tick.
  void wait_until_idle(const Running& running);
  // Lets message time advance to t in one step. All services must be idle.
  void jump(Utime t) { barrier_.allow_until(t); }
  // The newest message of each stream that a service reported as published.
  std::vector<stream_seq_t> reported() const;

 private:
  void on_done(const lcm::ReceiveBuffer* buffer, const std::string& channel);
  template <class Missing>
  void wait(const Missing& missing, const Running& running);

  lcm::LCM& bus_;
  lcm::LCM& reports_;
  Barrier barrier_;
  StreamCounter streams_;
  std::vector<stream_seq_t> listed_;
  std::map<ArrivalLedger::Key, stream_seq_t> reported_;
  std::vector<done_t> dones_;  // their streams are not yet listed by a tick
  std::vector<std::uint8_t> last_tick_;
};

}  // namespace rover::replay
