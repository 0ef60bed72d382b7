// Decides whether the rover may move: reads every stream, judges the rows of FDIR, runs the machines of level and
// state, grants the lease.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "supervisor/derive.hpp"
#include "supervisor/fdir.hpp"
#include "supervisor/inputs.hpp"
#include "supervisor/level_judge.hpp"
#include "supervisor/path_level.hpp"
#include "supervisor/service_keeper.hpp"
#include "supervisor/state_machine.hpp"

namespace rover::supervisor {

struct SupervisorConfig {
  FdirConfig fdir;
  DeriveConfig derive;
  LevelConfig level;
  ServiceKeeperConfig keeper;
  double max_speed_mps = 0.2;
  double teleop_speed_mps = 0.1;
  double teleop_max_age_s = 0.5;  // of the operator's newest motion command
  double permit_validity_s = 0.2;
  // For the start and for each permit, where no row of FDIR that stops the rover says otherwise.
  double pose_max_age_s = 0.3;
  double planner_max_age_s = 0.3;
  double control_max_age_s = 0.3;
  double wheels_max_age_s = 0.2;
  double hazards_max_age_s = 1.2;
  double heartbeat_max_age_s = 1.0;
  double terrain_max_way_m = 1.5;  // driven since the newest map of the Full level
  double terrain_known_ahead = 0.3;
  double terrain_known_around = 0.5;  // ends a sweep ...
  double sweep_patience_s = 25.0;     // ... which after that time is content with what is known ahead
  double hazard_stop_m = 0.5;
  double unseen_stop_m = 0.25;
  double stop_hysteresis_m = 0.15;
  double goal_tolerance_m = 0.5;
  double standing_speed_mps = 0.03;
  double standing_rate_radps = 0.03;
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

enum class ForcedLevel : std::int8_t { kEfficient = 0, kFull = 1, kAuto = 2 };

struct GroundCommand {
  std::int64_t id = 0;
  CommandKind kind = CommandKind::kStop;
  std::string target;                      // CLEAR_FAULT
  ForcedLevel level = ForcedLevel::kAuto;  // FORCE_LEVEL
};

struct Evidence {
  std::string quantity;
  double value = kNaN;
  double threshold = kNaN;
  double persistence_s = 0.0;
  double data_age_s = 0.0;
};

// Of the state, or, where the state stays, of the level.
struct StateChange {
  State from = State::kBoot;
  State to = State::kBoot;
  Level level_from = Level::kEfficient;
  Level level_to = Level::kEfficient;
  std::string cause;
  Evidence evidence;
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
  std::vector<std::string> restarts;  // services to be killed, so that they start anew
};

// What outlives a restart of the supervisor.
struct Memory {
  State state = State::kBoot;
  Level level = Level::kEfficient;
  bool raised_by_path = false;
  ForcedLevel forced = ForcedLevel::kAuto;
  int hazard_stops = 0;
  std::vector<std::string> faults;

  bool operator==(const Memory&) const = default;
};

class Supervisor {
 public:
  explicit Supervisor(const SupervisorConfig& config);

  // The newest of each stream; commands are carried out at the next step, in their order.
  void on_service(const std::string& name, const ServiceReport& report);
  void on_pose(const PoseReport& pose) { in_.pose = pose; }
  void on_hazards(const HazardsReport& hazards);
  void on_planner(const PlannerReport& planner) { in_.planner = planner; }
  void on_control(const ControlReport& control) { in_.control = control; }
  void on_slip(const SlipReport& slip) { in_.slip = slip; }
  void on_wheels(const WheelReport& wheels);
  void on_imu(const ImuReport& imu) { in_.imu = imu; }
  void on_terrain(const TerrainReport& terrain);
  void on_slam(const SlamReport& slam) { in_.slam = slam; }
  void on_motion_command(Utime utime) { in_.motion_command_utime = utime; }
  void on_path(PathLevels path);
  void on_correction_wanted(bool wanted) { correction_wanted_ = wanted; }
  void on_command(const GroundCommand& command) { commands_.push_back(command); }

  SupervisorOutput step(Utime now);

  // Before the first step: goes on from where a supervisor before ended, never in a better state. What was under way
  // stands until everything is seen to be well again.
  void restore(const Memory& memory);
  Memory memory() const;

  State state() const { return state_; }
  Level level() const { return level_; }
  Utime since() const { return since_; }
  const StateChange& last_change() const { return last_change_; }
  int hazard_stops() const { return hazard_stops_; }
  // In the order in which they were raised.
  const std::vector<std::string>& standing_faults() const { return fdir_.standing(); }
  std::vector<FaultChange> standing_report() const { return fdir_.report(); }

 private:
  void begin(Utime now);
  Now judged(Utime now) const;
  void run_rows(Utime now, SupervisorOutput& out);
  void run_level(Utime now, SupervisorOutput& out);
  LevelFactSet level_facts(Utime now);
  void failing_fact(LevelFactSet& facts, Utime now);
  double failing_starts() const;
  FactSet facts(Utime now);
  void terrain_fact(FactSet& facts, Utime now);
  bool terrain_fresh() const;
  double sweep_s(Utime now) const;
  bool inputs_ready(Utime now) const;
  bool alive(const std::vector<std::string>& services, Utime now) const;
  bool standing_still() const;
  double stop_distance_m() const;
  double blocked_in_m() const;
  void set_fact(FactSet& facts, Fact fact, bool on, const Evidence& evidence);
  void set_level_fact(LevelFactSet& facts, LevelFact fact, bool on, const Evidence& evidence);
  void path_facts(FactSet& facts, double planner_age_s);
  void fault_facts(FactSet& facts);
  CommandAnswer answer(const GroundCommand& command, FactSet& facts, Utime now, SupervisorOutput& out);
  CommandAnswer teleop(const GroundCommand& command, FactSet& facts, Utime now, SupervisorOutput& out);
  CommandAnswer transition(const GroundCommand& command, Fact fact, FactSet& facts, Utime now, SupervisorOutput& out);
  CommandAnswer force_level(const GroundCommand& command, Utime now);
  CommandAnswer clear_fault(const GroundCommand& command, FactSet& facts, Utime now, SupervisorOutput& out);
  void fire(const Transition& row, Utime now, SupervisorOutput& out);
  void fire(const LevelTransition& row, SupervisorOutput& out);
  Permit permit(FactSet facts, Utime now) const;
  double speed_limit_mps() const;

  SupervisorConfig config_;
  Inputs in_;
  PathLevels path_;
  bool way_back_ = false;  // that path answers a fault whose remedy it is, or follows one that did
  bool correction_wanted_ = false;
  std::vector<GroundCommand> commands_;

  Derive derive_;
  Fdir fdir_;
  ServiceKeeper keeper_;
  LevelJudge judge_;
  std::array<Evidence, kFactCount> evidence_;
  std::array<Evidence, kLevelFactCount> level_evidence_;
  std::string blocking_fault_;  // the first of those standing that stops the rover
  std::string safe_fault_;
  State state_ = State::kBoot;
  Level level_ = Level::kEfficient;
  bool raised_by_path_ = false;
  bool path_full_ = false;  // the path asks for it, where the rover was when both were last known
  ForcedLevel forced_ = ForcedLevel::kAuto;
  Utime since_ = kNever;
  Utime teleop_utime_ = kNever;
  StateChange last_change_{State::kBoot, State::kBoot, Level::kEfficient, Level::kEfficient, "start", {}};
  std::int64_t blocked_path_id_ = -1;  // active when the path was found blocked
  int hazard_stops_ = 0;
  bool permitted_ = false;  // at the step before
};

}  // namespace rover::supervisor
