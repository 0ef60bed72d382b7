// The giver of ticks of a replay: as the simulator's, for services that are live over a log.
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

// A live service died, hangs or did not come up: the replay cannot go on.
class ServiceGone : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class TickGiver {
 public:
  using Running = std::function<bool()>;
  // `reports` brings DONE.
  TickGiver(const std::vector<std::string>& services, lcm::LCM& bus, lcm::LCM& reports);

  // Waits until every service is up.
  void wait_for_start(const Running& running);
  // A message that the next tick lists.
  void list(const std::string& channel, const header_t& header);
  // TICK(t), as soon as all have published what belongs before it.
  void give(Utime t, const Running& running);
  // Waits until all have done all work of the last tick.
  void wait_until_idle(const Running& running);
  // Message time may go on to t in one step: all are idle.
  void jump(Utime t) { barrier_.allow_until(t); }
  // The newest message of each stream that the services reported as published.
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
  std::vector<done_t> dones_;  // whose streams no tick has listed yet
  std::vector<std::uint8_t> last_tick_;
};

}  // namespace rover::replay
