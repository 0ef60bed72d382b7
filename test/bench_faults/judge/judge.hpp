// Evaluates a log of the bench from its messages and injections.
//
//   visible    the utime of the message that completes the row's persistence, or the instant at which an age passes it
//   detected   FAULT raises the row within a second of that
//   named      the first row raised since the injection began is the row itself, or one that the same cause must trip
//              before it (precursors), and the row follows
//   withdrawn  release of the first DRIVE_PERMIT that is not granted, where one was granted when the fault was visible
//   still      from then until neither the wheels turn nor the body moves (TRUTH)
//   false      raised although not visible in the messages
#pragma once

#include <lcm/lcm-cpp.hpp>
#include <map>
#include <optional>
#include <rover/command_ack_t.hpp>
#include <rover/fault_t.hpp>
#include <rover/ground_command_t.hpp>
#include <rover/truth_t.hpp>
#include <set>
#include <string>
#include <vector>

#include "test/bench_faults/judge/evidence.hpp"

namespace rover::bench_faults {

struct Verdict {
  std::int64_t injection_id = 0;
  std::string row;  // with its motor or service
  std::string line;
  std::string phase;
  std::string cause;
  bool stops = false;  // the row's response withdraws the permit
  Utime begun = kNever;
  Utime visible = kNever;
  Utime visible_release = kNever;  // of the message that made it visible
  Utime raised = kNever;
  std::string first_raised;
  bool detected = false;
  bool named = false;
  std::optional<double> withdrawn_s;              // since visible
  std::optional<double> withdrawn_since_known_s;  // since the release of the message that made it visible
  std::optional<double> still_s;                  // since withdrawn
  double speed_mps = 0.0;                         // of the fastest wheel at the withdrawal
};

struct FalseAlarm {
  Utime utime;
  std::string row;
};

class Judge {
 public:
  explicit Judge(const Settings& settings);

  // In the order of the log.
  void take(const std::string& channel, const std::uint8_t* data, int size);
  void finish();

  const std::vector<Verdict>& verdicts() const { return verdicts_; }
  const std::vector<FalseAlarm>& false_alarms() const { return false_alarms_; }
  // In message time.
  double duration_s() const { return to_seconds(last_tick_ - first_tick_); }

 private:
  struct Watched {
    Row row;
    Visibility visibility;
    Visible now;               // at the newest tick
    Utime last_tick = kNever;  // last tick at which it was visible
  };
  struct Raised {
    Utime utime;
    std::string row;
    bool excused = false;
  };
  void step(Utime tick);
  void add_command(const ground_command_t& command);
  void add_ack(const command_ack_t& ack);
  void add_permit(const drive_permit_t& permit);
  void note_withdrawal(Utime at);
  void add_fault(const fault_t& fault);
  void add_truth(const truth_t& truth);
  void begin(const injection_t& injection);
  void settle();
  void look_at_active(Utime tick);
  void measure_rest(Utime tick);
  Watched* find(const std::string& id);

  Deliveries deliveries_;
  Evidence evidence_;
  std::vector<Watched> rows_;
  double wheel_radius_m_;
  std::vector<Verdict> verdicts_;
  std::vector<FalseAlarm> false_alarms_;
  std::optional<Verdict> active_;
  bool granted_ = false;         // the newest permit
  Utime withdrawn_at_ = kNever;  // last withdrawal
  bool granted_when_visible_ = false;
  Utime stopping_since_ = kNever;
  std::map<std::string, bool> fault_active_;
  std::set<std::int64_t> clear_commands_;  // not yet answered
  std::map<std::int64_t, std::int8_t> level_commands_;
  std::vector<Raised> unproven_;  // raised, not yet visible
  double body_mps_ = 0.0;
  double turn_mps_ = 0.0;  // speed of the corner wheels in the body's turn
  double wheel_mps_ = 0.0;
  double yaw_rad_ = 0.0;
  Utime first_tick_ = kNever;
  Utime last_tick_ = kNever;
};

}  // namespace rover::bench_faults
