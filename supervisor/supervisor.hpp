// Core of the supervisor: evaluates the FDIR monitors, runs the level and state machines, and grants the drive permit.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "supervisor/derived_values.hpp"
#include "supervisor/fdir.hpp"
#include "supervisor/inputs.hpp"
#include "supervisor/level_selector.hpp"
#include "supervisor/on_demand.hpp"
#include "supervisor/path_level.hpp"
#include "supervisor/service_restarter.hpp"
#include "supervisor/state_machine.hpp"

namespace rover::supervisor {

struct SupervisorConfig {
  FdirConfig fdir;
  DerivedValueConfig derived;
  LevelConfig level;
  ServiceRestarterConfig restarts;
  // Run only while the Full level needs them; there FDIR requires fdir.full_services of them.
  std::vector<std::string> on_demand_services;
  double origin_height_m = 0.0;  // of the body origin above the ground
  double max_speed_mps = 0.2;
  double deceleration_mps2 = 0.118;
  double footprint_half_length_m = 0.9;
  double footprint_half_width_m = 0.5;
  double teleop_speed_mps = 0.1;
  double teleop_max_age_s = 0.5;  // of the newest operator command
  double permit_validity_s = 0.2;
  // Maximum input ages for start and permit; a stopping FDIR row on the same quantity overrides them.
  double pose_max_age_s = 0.3;
  double planner_max_age_s = 0.3;
  double control_max_age_s = 0.3;
  double wheels_max_age_s = 0.2;
  double hazards_max_age_s = 1.2;
  double heartbeat_max_age_s = 1.0;
  double terrain_max_distance_m = 1.5;  // distance driven since the newest Full-level map
  double terrain_known_ahead = 0.3;
  double terrain_known_around = 0.5;  // ends a sweep if both are reached ...
  double sweep_around_s = 25.0;       // ... after this time the known ground ahead is enough
  double stop_distance_m = 0.25;
  double advance_per_frame_m = 0.25;
  double stop_hysteresis_m = 0.15;
  double goal_tolerance_m = 0.5;
  double stationary_speed_mps = 0.03;
  double stationary_rate_radps = to_rad(1.7);
};

// Without SET_START_POSE, which localization acknowledges.
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
  std::string_view quantity;  // a literal, or of the configuration
  double value = kNaN;
  double threshold = kNaN;
  double persistence_s = 0.0;
  double data_age_s = 0.0;
};

// Change of the state or of the level.
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
  std::vector<std::string> restarts;  // services to kill so that s6 restarts them
  std::optional<bool> run_full;       // start or stop the services of the Full level
};

// State that survives a restart of the supervisor: what limits motion, and what the operator sees. These start anew,
// because their inputs refill them: windows of level selection and message loss, N-of-M and persistence of rows,
// hysteresis, teleoperation.
struct PersistentState {
  State state = State::kBoot;
  Level level = Level::kEfficient;
  bool raised_by_path = false;
  bool path_full = false;
  ForcedLevel forced = ForcedLevel::kAuto;
  int hazard_stops = 0;
  std::int64_t backtracking_path_id = -1;
  std::vector<std::string> faults;
  EventCounters counters;
  ServiceRestarter::Attempts restart_attempts;
  MotorHeat heat;
  Utime utime = kNever;  // message time of saving

  bool operator==(const PersistentState&) const = default;
};

class Supervisor {
 public:
  explicit Supervisor(const SupervisorConfig& config);

  // Newest data of each stream. Commands are executed in order at the next step.
  void on_service(const std::string& name, const ServiceReport& report);
  void on_pose(const PoseReport& pose) { inputs_.pose = pose; }
  void on_hazards(const HazardsReport& hazards);
  void on_planner(const PlannerReport& planner) { inputs_.planner = planner; }
  void on_control(const ControlReport& control) { inputs_.control = control; }
  void on_slip(const SlipReport& slip) { inputs_.slip = slip; }
  void on_wheels(const WheelReport& wheels);
  void on_imu(const ImuReport& imu) { inputs_.imu = imu; }
  void on_terrain(const TerrainReport& terrain);
  void on_slam(const SlamReport& slam) { inputs_.slam = slam; }
  void on_visual(const VisualReport& visual) { inputs_.visual = visual; }
  void on_motion_command(Utime utime) { inputs_.motion_command_utime = utime; }
  void on_path(PathLevels path);
  void on_command(const GroundCommand& command) { commands_.push_back(command); }

  SupervisorOutput step(Utime now);

  // Before the first step: restores the state of the previous process. A drive in progress restarts in FAULT_STOP until
  // all inputs are healthy. If the saved state is unusable (empty) or old, the first step enters SAFE.
  void restore(const std::optional<PersistentState>& saved);
  // Its utime is filled in by whoever saves it.
  PersistentState persistent_state() const;

  State state() const { return state_; }
  Level level() const { return level_; }
  Utime since() const { return since_; }
  const StateChange& last_change() const { return last_change_; }
  int hazard_stops() const { return hazard_stops_; }
  bool full_services_wanted() const { return on_demand_.state() == OnDemand::State::kRunning; }
  // Ids in the order of raising.
  const std::vector<std::string>& active_faults() const { return fdir_.active(); }
  std::vector<FaultChange> active_report() const { return fdir_.report(); }

 private:
  void begin(Utime now, SupervisorOutput& out);
  void check_restored(Utime now, SupervisorOutput& out);
  double keep_out_depth_m() const;
  MonitorContext monitor_context(Utime now) const;
  void run_monitors(Utime now, SupervisorOutput& out);
  void run_level(Utime now, SupervisorOutput& out);
  LevelFactSet level_facts(Utime now);
  bool on_demand(const std::string& service) const;
  void run_full_services(Utime now, LevelFactSet& facts, SupervisorOutput& out);
  void full_missing(const LevelTransition* rise_if_ready, bool ready, Utime now);
  void full_failing_fact(LevelFactSet& facts, Utime now);
  double failing_starts() const;
  FactSet facts(Utime now);
  void terrain_fact(FactSet& facts, Utime now);
  bool terrain_fresh() const;
  double sweep_s(Utime now) const;
  double full_missing_s(Utime now) const { return full_missing_ == kNever ? 0.0 : to_seconds(now - full_missing_); }
  bool inputs_ready(Utime now) const;
  bool alive(const std::vector<std::string>& services, Utime now) const;
  bool stationary() const;
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
  Inputs inputs_;
  double frame_interval_s_ = 0.0;  // of the last two HAZARDS; 0: not known yet
  PathLevels path_;
  std::int64_t backtracking_path_id_ = -1;  // path that recovers from a stop_backtrack fault; -1: none
  std::vector<GroundCommand> commands_;

  DerivedValueTracker derived_;
  Fdir fdir_;
  ServiceRestarter restarter_;
  LevelSelector level_selector_;
  OnDemand on_demand_;
  std::array<Evidence, kFactCount> evidence_;
  std::array<Evidence, kLevelFactCount> level_evidence_;
  std::string blocking_fault_;  // first active fault that stops the rover
  std::string safe_fault_;
  State state_ = State::kBoot;
  Level level_ = Level::kEfficient;
  bool raised_by_path_ = false;
  bool path_full_ = false;       // the path requires Full at the last known rover position
  Utime full_missing_ = kNever;  // since then path or ground require Full, and its services are not ready
  ForcedLevel forced_ = ForcedLevel::kAuto;
  Utime since_ = kNever;
  Utime teleop_utime_ = kNever;
  StateChange last_change_{State::kBoot, State::kBoot, Level::kEfficient, Level::kEfficient, "start", {}};
  std::int64_t blocked_path_id_ = -1;  // path id at the last HAZARD_STOP
  int hazard_stops_ = 0;
  bool permitted_ = false;  // at the previous step
  bool restored_ = false;
  Utime restored_utime_ = kNever;  // when the restored state was saved; kNever: it was unusable
};

}  // namespace rover::supervisor
