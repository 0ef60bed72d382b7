// Data of ./rover status. NaN or empty: unknown.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/core/frames.hpp"
#include "common/core/time.hpp"

namespace rover::status {

// STATE and DRIVE_PERMIT.
struct StateReport {
  Utime utime = kNever;
  std::string state;
  std::string level;
  std::vector<std::string> stopped;  // services that the level does not need
  Utime since = kNever;
  std::string cause;
  std::string quantity;  // of the cause, else empty
  double value = kNaN;
  double threshold = kNaN;
  int hazard_stops = 0;
  std::vector<std::string> faults;  // ids of active faults, the first one first
};

struct PermitReport {
  bool granted = false;
  std::string reason;  // why the rover may not drive
};

struct FaultReport {
  Utime utime = kNever;
  std::string id;
  std::string condition;  // empty: the row is active but no FAULT was received
  std::string response;
  double value = kNaN;
  double limit = kNaN;
  Utime visible = kNever;
  bool active = false;
};

enum class Health { kUnknown, kOk, kDegraded, kFault };

// HEARTBEAT.
struct Heartbeat {
  Utime utime = kNever;
  std::string service;
  int pid = 0;
  Health health = Health::kUnknown;
  std::string text;
  double step_p50_ms = kNaN;
  double step_p99_ms = kNaN;
  std::int64_t gaps = 0;       // messages missed by its inputs since its start
  std::int64_t malformed = 0;  // messages dropped by its inputs
  std::int64_t out_of_order = 0;
  std::map<std::string, Utime> newest_input;  // measurement time by channel; only inputs that have received a message
};

// State of one service from s6 and the operating system.
struct ProcessFigures {
  int pid = 0;  // 0: none
  bool alive = false;
  std::optional<int> restarts;
  double cpu_percent = kNaN;  // of one core, in wall time
  double rss_mb = kNaN;
};

struct ServiceStatus {
  ProcessFigures process;
  double age_s = kNaN;    // since the last HEARTBEAT, see BusStatistics
  double quiet_s = kNaN;  // age unknown: lower bound of it
  std::optional<Heartbeat> heartbeat;
  bool wanted = true;  // false: stopped until its level needs it
};

struct ChannelStatus {
  double hz = kNaN;           // per second of message time
  double wall_hz = kNaN;      // per second of wall time
  double bytes_per_s = kNaN;  // per second of wall time
  double age_s = kNaN;        // newest message relative to the newest TICK
  std::int64_t gaps = 0;      // missing sequence numbers while status listened
  std::int64_t malformed = 0;
};

struct FaultStatus {
  FaultReport report;
  double for_s = kNaN;  // since the fault became visible
};

struct Snapshot {
  std::string run_dir;  // empty: no run, only a bus
  std::string bus_url;
  Utime now = kNever;             // newest TICK
  double realtime_factor = kNaN;  // message time over wall time
  double tick_silence_s = kNaN;   // wall time since the newest TICK
  std::optional<StateReport> state;
  double state_for_s = kNaN;
  std::optional<PermitReport> permit;
  std::vector<FaultStatus> faults;
  std::map<std::string, ServiceStatus> services;
  std::map<std::string, ChannelStatus> channels;
};

}  // namespace rover::status
