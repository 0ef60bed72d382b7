// Keeps what was heard on the bus, and sums it up. Knows no bus and no clock: wall time is an argument.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "tools/status/message_clock.hpp"
#include "tools/status/snapshot.hpp"
#include "tools/status/stream_account.hpp"

namespace rover::status {

// The header of a message.
struct Heard {
  std::string channel;
  std::string publisher;
  std::int64_t boot_id = 0;
  std::int64_t seq = 0;
  Utime utime = kNever;
  size_t bytes = 0;
};

class Account {
 public:
  // Each message of any channel, whatever else is made of it.
  void hear(const Heard& message);
  void hear_malformed(const std::string& channel) { ++malformed_[channel]; }
  void hear_tick(const std::string& publisher, Utime utime, double wall_s);
  void hear_heartbeat(const Heartbeat& heartbeat);
  void hear_state(const StateReport& state);
  void hear_permit(const PermitReport& permit) { permit_ = permit; }
  void hear_fault(const FaultReport& fault);

  // Process numbers by the services' own word.
  std::map<std::string, int> pids() const;
  // `processes`: of s6 and the system; services that only the bus knows are added. A service's age is that of its last
  // heartbeat in message time. The giver of ticks sends none: its age is the wall time since its last tick.
  Snapshot snapshot(const std::map<std::string, ProcessFigures>& processes, double wall_s) const;

 private:
  using Stream = std::pair<std::string, std::string>;  // channel, publisher
  void add_heard_channels(Snapshot& out, const Window& window) const;
  void add_channels_of_inputs(Snapshot& out, const Window& window) const;
  void add_faults(Snapshot& out) const;
  FaultStatus status_of(const FaultReport& fault) const;
  void add_services(Snapshot& out, const Window& window) const;

  MessageClock clock_;
  std::string clock_publisher_;
  std::map<Stream, StreamAccount> streams_;
  std::map<std::string, std::int64_t> malformed_;
  std::map<std::string, Heartbeat> heartbeats_;
  std::optional<StateReport> state_;
  std::optional<PermitReport> permit_;
  std::map<std::string, FaultReport> faults_;  // the newest word on each
};

}  // namespace rover::status
