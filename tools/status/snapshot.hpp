// What ./rover status shows: plain figures, NaN or empty where a thing is not known.
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
  Utime since = kNever;
  std::string cause;
  std::string quantity;  // behind the cause, else empty
  double value = kNaN;
  double threshold = kNaN;
  int hazard_stops = 0;
  std::vector<std::string> faults;  // ids of those standing, the first one first
};

struct PermitReport {
  bool granted = false;
  std::string reason;  // why not
};

struct FaultReport {
  Utime utime = kNever;
  std::string id;
  std::string condition;  // empty: the row was not heard, only that it stands
  std::string response;
  double value = kNaN;
  double limit = kNaN;
  Utime visible = kNever;
  bool standing = false;
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
  std::int64_t gaps = 0;       // messages that its inputs missed since its start
  std::int64_t malformed = 0;  // and those that it dropped
  std::int64_t out_of_order = 0;
  std::map<std::string, Utime> newest_input;  // by channel, of the measurement; only of inputs that came
};

// What s6 and the operating system know of one service.
struct ProcessFigures {
  int pid = 0;  // 0: none
  bool alive = false;
  std::optional<int> restarts;
  double cpu_percent = kNaN;  // of one core, of wall time
  double rss_mb = kNaN;
};

struct ServiceStatus {
  ProcessFigures process;
  double age_s = kNaN;    // of the last sign of life, see Account
  double quiet_s = kNaN;  // where the age is not known: at least this long
  std::optional<Heartbeat> heartbeat;
};

struct ChannelStatus {
  double hz = kNaN;           // of message time
  double wall_hz = kNaN;      // of wall time
  double bytes_per_s = kNaN;  // of wall time
  double age_s = kNaN;        // of the newest message against the newest TICK
  std::int64_t gaps = 0;      // missing by sequence number while status listened
  std::int64_t malformed = 0;
};

struct FaultStatus {
  FaultReport report;
  double for_s = kNaN;  // since it was visible
};

struct Snapshot {
  std::string run_dir;  // empty: none, the bus alone
  std::string bus_url;
  Utime now = kNever;             // newest TICK
  double realtime_factor = kNaN;  // message time over wall time
  double tick_silence_s = kNaN;   // wall time since that TICK
  std::optional<StateReport> state;
  double state_for_s = kNaN;
  std::optional<PermitReport> permit;
  std::vector<FaultStatus> faults;
  std::map<std::string, ServiceStatus> services;
  std::map<std::string, ChannelStatus> channels;
};

}  // namespace rover::status
