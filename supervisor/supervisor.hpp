// Decides whether the rover may move: reads every stream, runs the monitors and the state machine, grants the lease.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/core/frames.hpp"
#include "common/core/time.hpp"
#include "supervisor/monitor.hpp"
#include "supervisor/state_machine.hpp"

namespace rover::supervisor {

struct SupervisorConfig {
  std::vector<std::string> required_services;
  double max_speed_mps = 0.2;
  double permit_validity_s = 0.2;
  double pose_max_age_s = 0.3;
  double hazards_max_age_s = 1.2;  // 2.5 Hz with 0.24 s latency: one lost frame is 1.06 s
  double planner_max_age_s = 0.3;
  double control_max_age_s = 0.3;
  double heartbeat_max_age_s = 1.0;
  int blind_frames = 3;          // in a row
  double path_mismatch_s = 1.0;  // controller follows another path than the planner's
  double no_path_s = 20.0;
  double blocked_s = 60.0;  // standing before a hazard that no repair leads around
  double clear_confirm_s = 1.0;
  double slip_limit = 0.8;  // logged [HDPR]
  double slip_persistence_s = 5.0;
  double hazard_stop_m = 0.5;
  double unseen_stop_m = 0.25;
  double stop_hysteresis_m = 0.15;
  double goal_tolerance_m = 0.5;
  double standing_speed_mps = 0.03;
  double standing_rate_radps = 0.03;
};

// What the supervisor uses of the messages; utime of the measurement.
struct PoseReport {
  Utime utime = kNever;
  bool usable = false;  // status tells of a position, all numbers finite
  double speed_mps = kNaN;
  double turn_rate_radps = kNaN;
};

struct HazardsReport {
  Utime utime = kNever;
  bool blind = true;
};

enum class PlannerState : std::int8_t { kIdle = 0, kFollowing = 1, kRepairing = 2, kNoPath = 3 };
enum class BlockKind : std::int8_t { kNone = 0, kHazard = 1, kUnseen = 2 };

struct PlannerReport {
  Utime utime = kNever;
  PlannerState state = PlannerState::kIdle;
  std::int64_t path_id = -1;
  double blocked_in_m = kNaN;
  BlockKind block_kind = BlockKind::kNone;
  double goal_distance_m = kNaN;
};

struct ControlReport {
  Utime utime = kNever;
  bool path_end = false;
  bool out_of_corridor = false;
  std::int64_t path_id = -1;
  double cross_track_m = kNaN;
  double corridor_half_width_m = kNaN;
};

struct SlipReport {
  Utime utime = kNever;
  bool valid = false;
  double ratio = kNaN;
};

// SET_START_POSE is localization's to answer.
enum class CommandKind : std::int8_t {
  kGo = 1,
  kStop = 2,
  kPause = 3,
  kResume = 4,
  kTeleop = 5,
  kForceLevel = 6,
  kClearFault = 7,
  kEmergencyStop = 8,
  kClearSafe = 9,
  kInject = 10,
};

struct GroundCommand {
  std::int64_t id = 0;
  CommandKind kind = CommandKind::kStop;
  std::string target;  // CLEAR_FAULT
};

struct Evidence {
  std::string quantity;
  double value = kNaN;
  double threshold = kNaN;
  double persistence_s = 0.0;
  double data_age_s = 0.0;
};

struct StateChange {
  State from = State::kBoot;
  State to = State::kBoot;
  std::string cause;
  Evidence evidence;
};

struct FaultChange {
  std::string id;
  Condition condition = Condition::kFalse;
  Response response = Response::kLog;
  double value = kNaN;
  double limit = kNaN;
  Utime visible_utime = kNever;
  bool standing = false;
  bool first = false;
};

struct CommandAnswer {
  std::int64_t id = 0;
  bool accepted = false;
  std::string reason;
};

struct Permit {
  bool granted = false;
  double max_speed_mps = 0.0;
  Utime valid_until = kNever;
  std::string reason;
};

struct SupervisorOutput {
  Permit permit;
  std::vector<StateChange> changes;
  std::vector<FaultChange> faults;
  std::vector<CommandAnswer> answers;
};

class Supervisor {
 public:
  explicit Supervisor(const SupervisorConfig& config);

  // The newest of each stream; commands are carried out at the next step, in their order.
  void on_heartbeat(const std::string& service, Utime utime);
  void on_pose(const PoseReport& pose) { pose_ = pose; }
  void on_hazards(const HazardsReport& hazards);
  void on_planner(const PlannerReport& planner) { planner_ = planner; }
  void on_control(const ControlReport& control) { control_ = control; }
  void on_slip(const SlipReport& slip) { slip_ = slip; }
  void on_command(const GroundCommand& command) { commands_.push_back(command); }

  SupervisorOutput step(Utime now);

  State state() const { return state_; }
  Utime since() const { return since_; }
  const StateChange& last_change() const { return last_change_; }
  int hazard_stops() const { return hazard_stops_; }
  // In the order in which they were raised.
  const std::vector<std::string>& standing_faults() const { return standing_; }

 private:
  struct Watch {
    Monitor monitor;
    Reading (Supervisor::*read)(const Watch& watch, Utime now) const;
    std::string service;  // of heartbeat rows
  };
  using Read = Reading (Supervisor::*)(const Watch&, Utime) const;

  void add(const char* id, const char* quantity, double limit, double persistence_s, Read read);
  void add_streams();
  void add_path_rows();
  Reading read_pose_age(const Watch& watch, Utime now) const;
  Reading read_pose_status(const Watch& watch, Utime now) const;
  Reading read_hazards_age(const Watch& watch, Utime now) const;
  Reading read_hazards_blind(const Watch& watch, Utime now) const;
  Reading read_planner_age(const Watch& watch, Utime now) const;
  Reading read_control_age(const Watch& watch, Utime now) const;
  Reading read_heartbeat(const Watch& watch, Utime now) const;
  Reading read_corridor(const Watch& watch, Utime now) const;
  Reading read_path_mismatch(const Watch& watch, Utime now) const;
  Reading read_no_path(const Watch& watch, Utime now) const;
  Reading read_blocked(const Watch& watch, Utime now) const;
  Reading read_slip(const Watch& watch, Utime now) const;

  void run_monitors(Utime now, SupervisorOutput& out);
  void record(const Watch& watch, SupervisorOutput& out);
  FactSet facts(Utime now);
  bool inputs_ready(Utime now) const;
  bool services_alive(Utime now) const;
  bool standing_still() const;
  double stop_distance_m() const;
  double blocked_in_m() const;
  void set_fact(FactSet& facts, Fact fact, bool on, const Evidence& evidence);
  void path_facts(FactSet& facts, double planner_age_s);
  void fault_fact(FactSet& facts);
  CommandAnswer answer(const GroundCommand& command, FactSet& facts, Utime now, SupervisorOutput& out);
  CommandAnswer clear_fault(const GroundCommand& command, FactSet& facts, SupervisorOutput& out);
  void fire(const Transition& row, Utime now, SupervisorOutput& out);
  Permit permit(FactSet facts, Utime now) const;

  SupervisorConfig config_;
  std::vector<Watch> watches_;
  std::vector<std::string> standing_;
  std::string blocking_fault_;  // the first of those standing that stops the rover
  std::array<Evidence, kFactCount> evidence_;
  std::map<std::string, Utime> heartbeats_;
  PoseReport pose_;
  HazardsReport hazards_;
  int blind_in_a_row_ = 0;
  PlannerReport planner_;
  ControlReport control_;
  SlipReport slip_;
  std::vector<GroundCommand> commands_;
  State state_ = State::kBoot;
  Utime since_ = kNever;
  StateChange last_change_{State::kBoot, State::kBoot, "start", {}};
  std::int64_t blocked_path_id_ = -1;  // active when the path was found blocked
  int hazard_stops_ = 0;
};

}  // namespace rover::supervisor
