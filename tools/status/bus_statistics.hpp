// Statistics of the messages received on the bus. Wall time is an argument.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "tools/status/message_clock.hpp"
#include "tools/status/snapshot.hpp"
#include "tools/status/stream_statistics.hpp"

namespace rover::status {

// Header of a received message.
struct MessageInfo {
  std::string channel;
  std::string publisher;
  std::int64_t boot_id = 0;
  std::int64_t seq = 0;
  Utime utime = kNever;
  size_t bytes = 0;
};

class BusStatistics {
 public:
  // Counts every message of any channel.
  void add_message(const MessageInfo& message);
  void add_malformed(const std::string& channel) { ++malformed_[channel]; }
  void add_tick(const std::string& publisher, Utime utime, double wall_s);
  void add_heartbeat(const Heartbeat& heartbeat);
  void add_state(const StateReport& state);
  void add_permit(const PermitReport& permit) { permit_ = permit; }
  void add_fault(const FaultReport& fault);

  // Process ids from the heartbeats.
  std::map<std::string, int> pids() const;
  // `processes`: from s6 and the system. Service age: since its last HEARTBEAT; the clock master sends none, so since
  // its last TICK.
  Snapshot snapshot(const std::map<std::string, ProcessFigures>& processes, double wall_s) const;

 private:
  using Stream = std::pair<std::string, std::string>;  // channel, publisher
  void add_received_channels(Snapshot& out, const Window& window) const;
  void add_channels_of_inputs(Snapshot& out, const Window& window) const;
  void add_faults(Snapshot& out) const;
  FaultStatus status_of(const FaultReport& fault) const;
  void add_services(Snapshot& out, const Window& window) const;

  MessageClock clock_;
  std::string clock_publisher_;
  std::map<Stream, StreamStatistics> streams_;
  std::map<std::string, std::int64_t> malformed_;
  std::map<std::string, Heartbeat> heartbeats_;
  std::optional<StateReport> state_;
  std::optional<PermitReport> permit_;
  std::map<std::string, FaultReport> faults_;  // newest report of each fault
};

}  // namespace rover::status
